# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a report page with parsers that are not ours: well-formed, self-contained, pictures whole.

usage: page_check.py PAGE PICTURES, with the number of <img> elements that PAGE must have."""
import base64
import html.parser
import re
import struct
import sys
import xml.etree.ElementTree
import zlib

VOID = {"br", "wbr", "img", "input", "meta", "link", "hr"}
ADDRESSES = {"src", "href", "action", "data", "poster", "srcset", "xlink:href"}


class Page(html.parser.HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.faults, self.open, self.pictures, self.ids, self.targets = [], [], [], set(), set()

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)
        self.look_at(tag, attributes)

    def handle_startendtag(self, tag, attributes):
        self.look_at(tag, attributes)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()} closes nothing")

    def look_at(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.ids.add(value)
            if name in ADDRESSES and value.startswith("#"):
                self.targets.add(value[1:])
            elif name in ADDRESSES and not value.startswith("data:image/png;base64,"):
                self.faults.append(f"<{tag} {name}={value[:60]!r}> leaves the page")
            elif tag == "img" and name == "src":
                self.pictures.append(base64.b64decode(value.split(",", 1)[1], validate=True))


def png_fault(png: bytes) -> str:
    if png[:8] != b"\x89PNG\r\n\x1a\n":
        return "no PNG"
    at, data = 8, b""
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        body = png[at + 8:at + 8 + length]
        if struct.unpack(">I", png[at + 8 + length:at + 12 + length])[0] != zlib.crc32(kind + body):
            return f"checksum of {kind}"
        data += body if kind == b"IDAT" else b""
        at += 12 + length
    return "" if zlib.decompress(data) else "no pixels"


def main(path: str, pictures: int) -> int:
    text = open(path, encoding="utf-8").read()
    page = Page()
    page.feed(text)
    page.close()
    faults = page.faults + [f"{tag} is not closed" for tag in page.open]
    faults += [f"#{target} is nowhere" for target in page.targets - page.ids]
    faults += [fault for fault in map(png_fault, page.pictures) if fault]
    if len(page.pictures) != pictures:
        faults.append(f"{len(page.pictures)} pictures, expected {pictures}")
    outside = [url for url in re.findall(r"(?:https?:)?//[\w.-]+\.\w+[^\s\"'<]*", re.sub(r"base64,[^\"]*", "", text))
               if "www.w3.org" not in url]  # names of XML vocabularies, never fetched
    faults += [f"mentions {url}" for url in outside]
    faults += [f"style has {word}" for word in ("@import", "url(") if word in text]
    xml.etree.ElementTree.fromstring(text.split("\n", 1)[1])  # behind the doctype; throws on a fault
    print("\n".join(faults))
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2])))

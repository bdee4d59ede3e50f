# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Mends the hashes and checksums that an input carries, so that a changed file is read as if it had been written so.

Without it nearly every mutation of a hashed file ends at the hash, and what lies behind is never reached.
"""
import hashlib
import json
import pathlib
import re

from mutators import tar_members

RECORDS = (".json", ".jsonl", ".yaml", ".urdf", ".sha256", ".txt")


def make_crc_table() -> list[int]:
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = (byte >> 1) ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


CRC_TABLE = make_crc_table()


def crc32c(content: bytes) -> int:
    """RFC 3720."""
    crc, table = 0xFFFFFFFF, CRC_TABLE
    for byte in content:
        crc = (crc >> 8) ^ table[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def seal_hashes(folder: pathlib.Path, path: pathlib.Path, old: bytes, new: bytes) -> None:
    """Writes `new` to `path` and its SHA-256 wherever a record below `folder` has that of `old`, and so on for these
    records; a file that is named after its hash is renamed."""
    waiting = [(path, old, new)]
    for _ in range(100):  # records do not name each other in circles; a mutated one may
        if not waiting:
            break
        path, old, new = waiting.pop()
        before, after = hashlib.sha256(old).hexdigest().encode(), hashlib.sha256(new).hexdigest().encode()
        short = path.stem == before[:20].decode()
        path.write_bytes(new)
        if short:
            path.rename(path.with_name(after[:20].decode() + path.suffix))
        for record in sorted(other for other in folder.rglob("*") if other.suffix in RECORDS and other.is_file()):
            text = record.read_bytes()
            changed = text.replace(before, after)
            if short:
                changed = changed.replace(before[:20], after[:20])
            if changed != text and record != path:
                waiting.append((record, text, changed))
                record.write_bytes(changed)


def seal_index(index: pathlib.Path, tar: bytes) -> bytes | None:
    """The index's text for this tar: offsets, sizes, checksums, hash. Nothing if the index knows other members."""
    # real numbers keep their digits
    document = json.loads(index.read_bytes(), parse_float=lambda digits: "@real@" + digits)
    found = {name: (at + 512, size) for at, name, size in tar_members(tar)}
    for episode in document["episodes"]:
        for member in episode["members"]:
            place = found.get(f"{episode['key']}.{member['name']}")
            if place is None:
                return None
            if member["size"] == place[1] and member["crc32c"] == crc32c(tar[place[0]:place[0] + place[1]]):
                member["offset"] = place[0]
                continue
            member.update(offset=place[0], size=place[1], crc32c=crc32c(tar[place[0]:place[0] + place[1]]))
    document.update(tar_bytes=len(tar), tar_sha256=hashlib.sha256(tar).hexdigest())
    return index_text(document)


def index_text(document: dict) -> bytes:
    document.pop("index_crc32c", None)

    def text() -> bytes:
        return re.sub(r'"@real@([^"]*)"', r"\1", json.dumps(document, indent=2, ensure_ascii=False)).encode() + b"\n"

    document["index_crc32c"] = crc32c(text())
    return text()


def seal_journal(content: bytes) -> bytes:
    """Each line's checksum is mended."""
    lines = [line[9:] for line in content.split(b"\n") if len(line) > 9]
    return b"".join(b"%08x %s\n" % (crc32c(line), line) for line in lines)


def seal(folder: pathlib.Path, path: pathlib.Path, old: bytes, new: bytes) -> None:
    """`path` below `folder` becomes `new`, and what vouches for its bytes is mended."""
    if path.suffix == ".journal":
        path.write_bytes(seal_journal(new))
        return
    if path.name.endswith(".index.json"):
        try:
            document = json.loads(new, parse_float=lambda digits: "@real@" + digits)
            new = index_text(document) if isinstance(document, dict) else new
        except (ValueError, RecursionError):
            pass
    index = path.with_name(path.stem + ".index.json")
    seal_hashes(folder, path, old, new)
    if path.suffix == ".tar" and index.is_file():
        text = seal_index(index, new)
        if text is not None:
            seal_hashes(folder, index, index.read_bytes(), text)

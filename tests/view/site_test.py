# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The documents as a site: it builds strictly, no link leads nowhere (files and anchors, by a reader of HTML of its own), nothing is
asked of the network, every verb has its page, and doors stand in it in 3D.

usage: site_test.py BUILD"""
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

from pages import BUILD, PageTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What a browser fetches by itself, by the element's name.
FETCHED = {"script": "src", "img": "src", "iframe": "src", "link": "href", "source": "src", "video": "src"}


class Page(html.parser.HTMLParser):
    def __init__(self, path: pathlib.Path) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.feed(path.read_text())

    def handle_starttag(self, tag: str, attributes: list) -> None:
        said = dict(attributes)
        self.anchors |= {said[key] for key in ("id", "name") if said.get(key)}
        if tag == "a" and said.get("href"):
            self.links.append(said["href"])
        if said.get(FETCHED.get(tag, "")):
            self.fetched.append(said[FETCHED[tag]])


def built(out: pathlib.Path) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-B", ROOT / "scripts/site/build_site.py", BUILD, out], capture_output=True, text=True, timeout=300, check=False)


class Site(PageTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.site = cls.folder / "site"
        result = built(cls.site)
        assert result.returncode == 0, result.stdout + result.stderr
        # pages of the viewer are thousands of lines of script, and no documents
        cls.pages = {path: Page(path) for path in cls.site.rglob("*.html") if path.parent.name != "doors" or path.name == "index.html"}

    def test_no_link_leads_nowhere(self) -> None:
        dead = []
        for path, page in self.pages.items():
            for link in [*page.links, *page.fetched]:
                parts = urllib.parse.urlsplit(link)
                if parts.scheme in ("http", "https", "mailto", "data") or link == "#":
                    continue
                target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
                if target.is_dir():
                    target = target / "index.html"
                anchors = self.pages[target].anchors if target in self.pages else None
                if not target.is_file() or (parts.fragment and anchors is not None and urllib.parse.unquote(parts.fragment) not in anchors):
                    dead.append(f"{path.relative_to(self.site)}: {link}")
        self.assertEqual(dead, [])
        self.assertGreater(sum(len(page.links) for page in self.pages.values()), 1000)

    def test_nothing_is_fetched_from_elsewhere(self) -> None:
        elsewhere = [(str(path), link) for path, page in self.pages.items() for link in page.fetched if re.match(r"(\w+:)?//", link)]
        self.assertEqual(elsewhere, [])
        for style in self.site.rglob("*.css"):
            self.assertNotRegex(style.read_text(errors="replace"), r"url\(\s*['\"]?(https?:)?//")
        for page in ("index.html", "compose.html", "commands/view.html"):
            self.browser.open((self.site / page).as_uri(), ready=False)
            self.browser.wait("document.readyState === 'complete' && location.href !== 'about:blank'")
            self.assertEqual(self.browser.foreign_requests(), [])

    def search(self, words: str) -> list[str]:
        """Where the links lead that are found, from a page of the disk, by keyboard."""
        self.browser.js("document.getElementById('mkdocs-search-query').value = ''")
        self.browser.call("Input.insertText", text=words)
        self.browser.wait("document.querySelector('#mkdocs-search-results .found') !== null")
        return self.browser.js("[...document.querySelectorAll('#mkdocs-search-results article a')].map((link) => link.getAttribute('href'))")

    def test_the_search_works_from_the_disk(self) -> None:
        self.browser.open((self.site / "commands/view.html").as_uri(), ready=False)
        self.browser.wait("document.readyState === 'complete' && location.href.endsWith('view.html')")
        # The theme listens to keys some time after the page is complete, and dresses tables next; a key before that is lost.
        self.browser.wait("document.querySelector('#mkdocs_keyboard_modal table').classList.contains('table-hover')")
        self.browser.call("Input.dispatchKeyEvent", type="keyDown", key="s", windowsVirtualKeyCode=83)  # the theme's key for it
        self.browser.wait("document.activeElement.id === 'mkdocs-search-query'")
        self.assertIn("../commands/compose.html#doorforge-compose", self.search("--handle-front"))
        text = (ROOT / "docs/glossary.md").read_text()
        self.assertTrue(any("glossary.html" in link for link in self.search("backset")) or "backset" not in text.lower())
        self.assertEqual(self.search("no_such_word_anywhere"), [])
        self.assertIn("../serve.html#who-may-ask", self.search("Origin Host refused"))
        self.assertEqual(self.search("<img src=x onerror=alert(1)>"), [])
        first = self.search("gallery")[0]
        self.browser.key("Enter")
        self.browser.wait(f"location.href.includes({json.dumps(first.removeprefix('../').partition('#')[0])})")
        self.assertEqual(self.browser.foreign_requests(), [])

    def test_the_index_of_the_search_has_every_page(self) -> None:
        index = (self.site / "search/index.js").read_text()
        sections = json.loads(index.removeprefix("window.searchSections = ").removesuffix(";\n"))
        found = {section["location"].partition("#")[0] for section in sections}
        missing = {str(path.relative_to(self.site)) for path in self.pages} - found
        self.assertEqual(missing, set())
        for section in sections:
            path, _, anchor = section["location"].partition("#")
            self.assertIn(anchor, self.pages[self.site / path].anchors, path)

    def test_every_document_is_a_page_of_the_list(self) -> None:
        index = self.pages[self.site / "index.html"]
        for source in (ROOT / "docs").glob("*.md"):
            self.assertIn(f"{source.stem}.html", index.links, source)

    def test_the_command_lines_pages_say_what_help_says(self) -> None:
        said = json.loads(subprocess.run([BUILD / "bin/doorforge", "--describe-command"], capture_output=True, text=True, check=True).stdout)
        for verb in said["verbs"]:
            shown = html.unescape(re.sub(r"<[^>]+>", "", (self.site / f"commands/{verb['name']}.html").read_text()))
            usage = subprocess.run([BUILD / "bin/doorforge", verb["name"], "--help"], capture_output=True, text=True, check=True).stdout
            for option in set(re.findall(r"^\s+(?:-\w,)?(--[a-z][a-z-]+)", usage, re.M)):
                self.assertIn(option, shown, verb["name"])

    def test_doors_stand_in_it_in_3d(self) -> None:
        self.browser.open((self.site / "doors/index.html").as_uri(), ready=False)
        self.browser.wait("document.querySelectorAll('iframe').length === 4")
        for page in (self.site / "doors").glob("*.html"):
            if page.name == "index.html":
                continue
            self.browser.open(page.as_uri())
            self.assertEqual(self.browser.js("document.documentElement.dataset.failed ?? ''"), "")
        self.browser.open((self.site / "doors/lever.html").as_uri())
        self.assertTrue(self.browser.js("(doorforge.view.moveHinge(0.5), doorforge.view.latch.hinge < 0.01)"))


class DeadLinks(unittest.TestCase):
    def test_a_dead_link_stops_the_build(self) -> None:
        """In a copy of the documents, of which one has a link to nowhere."""
        with tempfile.TemporaryDirectory(dir=BUILD) as folder:
            copy = pathlib.Path(folder) / "tree"
            for name in ("docs", "scripts"):
                shutil.copytree(ROOT / name, copy / name)
            for path in ROOT.glob("*"):
                if path.is_file():
                    shutil.copy(path, copy)
            page = copy / "docs/glossary.md"
            page.write_text(page.read_text() + "\n[nowhere](nowhere.md)\n")
            result = subprocess.run([sys.executable, "-B", copy / "scripts/site/build_site.py", BUILD, copy / "site"], capture_output=True, text=True, timeout=300, check=False)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("nowhere.md", result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of pages share: running a verb, and a page in the browser."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

from browser import Browser

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()


def run(*arguments: object, code: int = 0) -> subprocess.CompletedProcess:
    result = subprocess.run([BUILD / "bin/doorforge", *map(str, arguments)], capture_output=True, text=True, timeout=300, check=False)
    assert result.returncode == code, (arguments, result.returncode, result.stdout, result.stderr)
    return result


class PageTest(unittest.TestCase):
    """A folder and a browser for all tests of a class; after each, the console is silent and nothing was asked for."""

    FLAGS: tuple = ()  # of the browser

    @classmethod
    def setUpClass(cls) -> None:
        scratch = tempfile.TemporaryDirectory(dir=BUILD)
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.browser = Browser(*cls.FLAGS)
        cls.addClassCleanup(cls.browser.__exit__)

    def setUp(self) -> None:
        self.browser.size(1200, 800)

    def tearDown(self) -> None:
        self.assertEqual(self.browser.errors, [])
        self.assertEqual(self.browser.foreign_requests(), [])

    def open(self, *paths: str, code: int = 0, options: tuple = ()) -> pathlib.Path:
        page = self.folder / "page.html"
        run("view", *(self.folder / path for path in paths), "--out", page, "--overwrite", *options, code=code)
        self.browser.open(page.as_uri())
        return page

    def click_text(self, text: str, within: str = "body") -> None:
        self.browser.js(f"[...document.querySelectorAll('{within} button')].find((b) => b.textContent === '{text}').click(), 0")
        self.browser.settle()

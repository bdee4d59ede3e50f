# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The man pages hold what the helps tell, and groff finds nothing amiss in them: man_pages_test.py BINARY_DIR"""
import gzip
import pathlib
import re
import subprocess
import sys
import unittest

from helps import read_helps

BINARY_DIR = pathlib.Path(sys.argv.pop(1))
PAGES = BINARY_DIR / "commands/man1"


def shown(page: pathlib.Path) -> subprocess.CompletedProcess:
    """The page as plain text, and groff's warnings on standard error."""
    return subprocess.run(["groff", "-man", "-Tascii", "-ww", "-rLL=200n", "-P-cbou"], input=gzip.decompress(page.read_bytes()),
                          capture_output=True, check=True)


def normal(text: str) -> str:
    return re.sub(r"[\s.]+", " ", text)


class ManPages(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.helps = read_helps(BINARY_DIR / "bin/doorforge")

    def test_groff_has_nothing_to_say(self):
        for page in PAGES.iterdir():
            with self.subTest(page.name):
                self.assertEqual(shown(page).stderr.decode(), "")

    def test_every_program_and_every_verb_has_a_page(self):
        wanted = {f"doorforge-{verb}" for verb in self.helps["doorforge"].commands}
        wanted |= {path.name for path in (BINARY_DIR / "bin").iterdir() if re.fullmatch("doorforge(-[a-z-]+)?", path.name)}
        self.assertEqual({page.name for page in PAGES.iterdir()}, {f"{name}.1.gz" for name in wanted})

    def test_a_page_holds_options_subcommands_and_values(self):
        for command, said in self.helps.items():
            page = shown(PAGES / ("-".join(command.split()[:2]) + ".1.gz")).stdout.decode()
            for option, values in said.options.items():
                with self.subTest(command, option=option):
                    value = re.escape("{" + ",".join(values) + "}") if values else ""
                    self.assertRegex(page, rf"(?m)^ +(-\S+, )*{option}(, -\S+)*\b ?{value}")
            for name in said.commands:
                with self.subTest(command, subcommand=name):
                    self.assertRegex(page, rf"(?m)^ +{name}\b")

    def test_a_page_says_what_the_help_says(self):
        """All words of the help, but for its headings and the notes beside an option's name, which are set otherwise."""
        for command in ("train", "datagen open", "act"):
            text = subprocess.run([BINARY_DIR / "bin/doorforge", *command.split(), "--help"], capture_output=True, text=True,
                                  check=True).stdout
            page = normal(shown(PAGES / f"doorforge-{command.split()[0]}.1.gz").stdout.decode())
            for line in text.splitlines():
                said = re.sub(r"^  -\S+ .*?(  |$)", "", line).strip()
                if not re.match(r"(Usage|Options|Positionals|  stage )", line) and said:
                    with self.subTest(command, line=line):
                        self.assertIn(normal(said), page)


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The four journeys of README.md run as they stand there; PYTHONPATH holds the package, the argument is the build folder."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
README = pathlib.Path(__file__).parents[2] / "README.md"


def blocks(language: str) -> list:
    """The code of the section, in its order."""
    section = README.read_text(encoding="utf-8").split("## Four journeys\n")[1].split("\n## ")[0]
    return [code for kind, code in re.findall(r"^```(\w*)\n(.*?)^```", section, re.M | re.S) if kind == language]


class Journeys(unittest.TestCase):
    def run_blocks(self, language: str, program: list) -> str:
        told = ""
        with tempfile.TemporaryDirectory() as scratch:
            for block in blocks(language):
                done = subprocess.run([*program, block], cwd=scratch, capture_output=True, text=True, check=False, timeout=600,
                                      env={**os.environ, "PATH": f"{BUILD / 'bin'}:{os.environ['PATH']}"})
                self.assertEqual(done.returncode, 0, block + done.stderr)
                told += done.stdout
            for made in ("doors/mine/door.json", "data/dataset.json"):
                self.assertTrue(pathlib.Path(scratch, made).exists(), made)
        return told

    def check_length(self, language: str) -> None:
        """Four journeys, each in five lines."""
        self.assertEqual(len(blocks(language)), 4)
        for block in blocks(language):
            self.assertLessEqual(len(block.splitlines()), 5, block)

    def test_on_the_command_line(self) -> None:
        self.check_length("")
        self.assertRegex(self.run_blocks("", ["bash", "-euc"]), r"overall +\d+\.\d %")

    def test_in_python(self) -> None:
        self.check_length("python")
        told = self.run_blocks("python", [sys.executable, "-B", "-c"])
        self.assertRegex(told, r"\d+ \(4096, 3\)")
        self.assertRegex(told, r"overall +\d+\.\d %")


if __name__ == "__main__":
    unittest.main()

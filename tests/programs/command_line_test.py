# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""How the programs read their arguments: a setting takes one value, and a name that there is not is told the nearest."""
import os
import re
import shutil
import subprocess
import unittest

from programs import BINARY_DIR, ProgramTest, run

# every verb with settings -> arguments after which a word is one too many, or fills the place that it stands for; and
# what must not be said where that place is filled
WITH_SETTINGS = {
    "import": (["WORD", "--out", "OUT"], "SRC"),
    "repair": (["WORD", "OUT/closed.obj"], "OUT is required"),
    "compose": (["--out", "OUT", "WORD"], None),
    "simulate": (["--door", "OUT", "--seeds", "1", "WORD"], None),
    "datagen open": (["--doors", "OUT", "--out", "OUT/data", "WORD"], None),
    "datagen handle": (["--doors", "OUT", "--out", "OUT/data", "WORD"], None),
    "datagen grasp": (["--doors", "OUT", "--out", "OUT/data", "WORD"], None),
    "datagen plan": (["WORD", "--doors", "OUT"], "stage is required"),
    "dataset re-observe": (["WORD", "--out", "OUT", "--doors", "OUT"], "folder is required"),
    "train": (["WORD", "--data", "OUT", "--out", "OUT/policy"], "stage is required"),
    "reinforce": (["--doors", "OUT", "--out", "OUT/ppo", "WORD"], None),
    "eval": (["--opener", "expert", "--doors", "OUT", "WORD"], None),
    "act": (["--camera", "OUT", "WORD"], None),
    "sight": (["--door", "OUT", "--out", "OUT/sight", "WORD"], None),
    "pipeline": (["WORD", "--out", "OUT"], "preset is required"),
    "benchmark": (["WORD", "--out", "OUT"], "size is required"),
}


def listed(text: str, heading: str) -> list[str]:
    """The first words of the indented lines below a heading of a help."""
    lines = re.split(rf"^{heading}.*\n", text, maxsplit=1, flags=re.M)
    if len(lines) < 2:
        return []
    return re.findall(r"^  (\S+) ", re.split(r"\n\s*\n", lines[1])[0], re.M)


def verbs_with_settings() -> set[str]:
    found = set()
    for verb in listed(run("--help").stdout, "usage:") or re.findall(r"^  (\w+) +\S", run("--help").stdout, re.M):
        text = run(verb, "--help").stdout
        commands = [f"{verb} {name}" for name in listed(text, "Subcommands:")] or [verb]
        found |= {command for command in commands if "--set " in run(*command.split(), "--help").stdout.split("example")[0]}
    return found


class Settings(ProgramTest):
    def test_the_table_above_has_every_verb_that_has_settings(self):
        self.assertEqual(verbs_with_settings(), set(WITH_SETTINGS))

    def test_a_setting_does_not_swallow_what_follows(self):
        for verb, (arguments, missing) in WITH_SETTINGS.items():
            with self.subTest(verb):
                words = " ".join(arguments).replace("OUT", str(self.folder)).split()
                words[words.index("WORD"):words.index("WORD") + 1] = ["--set", "a_key=1", "a_word"]
                result = run(*verb.split(), *words)
                self.assert_ends(result, 2, 3)
                self.assertNotIn("--set a_word", result.stderr)
                if missing is None:
                    self.assertIn('"a_word" was not expected', result.stderr)
                else:
                    self.assertNotIn(missing, result.stderr)

    def test_a_setting_before_the_file_that_it_is_for(self):
        result = run("import", "--set", "visual=false", self.folder / "x.stl", "--role", "handle", "--category",
                     "interior", "--mechanism", "lever", "--out", self.folder / "parts")
        self.assertNotIn("required", result.stderr)
        self.assertIn("x.stl", result.stderr)

    def test_settings_are_given_one_by_one(self):
        result = run("train", "open", "--data", self.folder, "--out", self.folder / "p", "--set", "a=1", "b=2")
        self.assert_refused(result, 2)
        self.assertIn("--set b=2", result.stderr)


class Suggestions(ProgramTest):
    def assert_suggests(self, words: str, suggestion: str) -> None:
        with self.subTest(words):
            result = run(*words.split())
            self.assert_refused(result, 2)
            self.assertIn(f'did you mean "{suggestion}"?', result.stderr)

    def test_of_options(self):
        self.assert_suggests("compose --bodi interior_flush_01", "--body")
        self.assert_suggests("eval --openr expert", "--opener")
        self.assert_suggests("simulate --dor x", "--door")
        self.assert_suggests("dataset info data --hmtl x", "--html")
        self.assert_suggests("doctor --jsn", "--json")

    def test_of_subcommands(self):
        self.assert_suggests("catalog lst", "list")
        self.assert_suggests("dataset inf data", "info")
        self.assert_suggests("datagen opne --doors x", "open")

    def test_of_the_front_program(self):
        self.assert_suggests("--verison", "--version")
        self.assert_suggests("--hlp", "--help")
        self.assert_suggests("catalgo", "catalog")


class LargePages(ProgramTest):
    def allocator_is_told(self, **environment: str) -> str:
        """What of GLIBC_TUNABLES a verb's program sees, by one that prints it in the place of that of `import`."""
        shutil.copy(BINARY_DIR / "bin/doorforge", self.folder)
        program = self.folder / "doorforge-assets"
        program.write_text('#!/bin/sh\nprintf %s "$GLIBC_TUNABLES"\n')
        program.chmod(0o755)
        without = {name: value for name, value in os.environ.items() if name != "GLIBC_TUNABLES"}
        result = subprocess.run([self.folder / "doorforge", "import"], env={**without, **environment}, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_the_programs_of_verbs_are_told_to_use_them(self):
        self.assertEqual(self.allocator_is_told(), "glibc.malloc.hugetlb=1")

    def test_what_the_caller_told_stands(self):
        self.assertEqual(self.allocator_is_told(GLIBC_TUNABLES="glibc.malloc.check=0"), "glibc.malloc.check=0")


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""bash, fish and zsh complete every verb, option and value that a help tells: completion_test.py BINARY_DIR"""
import pathlib
import sys
import unittest

from helps import Help, read_helps
from shells import SHELLS

BINARY_DIR = pathlib.Path(sys.argv.pop(1))


def lines_of(command: str, said: Help) -> dict[str, set[str]]:
    """Lines as they would be typed -> what must be offered; of options only the exact word must be."""
    wanted = {f"{command} {name}": {name} for name in said.options if name.startswith("--")}
    wanted |= {f"{command} {option} ": set(values) for option, values in said.options.items() if values}
    if said.commands:
        wanted[f"{command} "] = set(said.commands)
    elif said.places and said.places[0]:
        wanted[f"{command} "] = set(said.places[0])
    return wanted


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.helps = read_helps(BINARY_DIR / "bin/doorforge")
        cls.wanted = {line: words for command, said in cls.helps.items() for line, words in lines_of(command, said).items()}

    def ask(self, shell: str, lines: list[str]) -> dict[str, set[str]]:
        script, ask = SHELLS[shell]
        return ask(BINARY_DIR / "commands" / script, lines)

    def test_the_helps_tell_something(self):
        self.assertGreater(len(self.helps), 20)
        self.assertIn("--doors", self.helps["doorforge datagen open"].options)
        self.assertEqual(self.helps["doorforge train"].places, [["open", "handle", "grasp", "motion", "find"]])
        self.assertEqual(self.helps["doorforge act"].options["--base"], ["sliders", "fixed"])

    def test_all_that_a_help_tells_is_offered(self):
        for shell in SHELLS:
            for line, offered in self.ask(shell, list(self.wanted)).items():
                with self.subTest(shell, line=line):
                    if line.endswith(" "):
                        self.assertEqual(offered, self.wanted[line])
                    else:
                        self.assertLessEqual(self.wanted[line], {word.split("=")[0] for word in offered})

    def test_options_offered_are_those_of_the_command(self):
        lines = [f"{command} --" for command in self.helps]
        for shell in SHELLS:
            for line, offered in self.ask(shell, lines).items():
                with self.subTest(shell, line=line):
                    known = {name for name in self.helps[line[:-3]].options if name.startswith("--")}
                    self.assertEqual({word.split("=")[0] for word in offered if word.startswith("--")}, known)

    def test_what_is_typed_already(self):
        lines = {"doorforge data": {"datagen", "dataset"}, "doorforge datagen open --doors a b --jso": {"--json"},
                 "doorforge act --text --base f": {"fixed"}, "doorforge datagen plan gr": {"grasp"},
                 "doorforge train --set a=1 --seed 3 ha": {"handle"}, "doorforge eval --seeds ": set()}
        for shell in SHELLS:
            for line, offered in self.ask(shell, list(lines)).items():
                with self.subTest(shell, line=line):
                    self.assertEqual(offered, lines[line])

    def test_a_value_behind_its_sign(self):
        for shell in SHELLS:
            offered = self.ask(shell, ["doorforge act --base="])["doorforge act --base="]
            with self.subTest(shell):
                self.assertEqual({word.removeprefix("--base=") for word in offered}, {"sliders", "fixed"})


if __name__ == "__main__":
    unittest.main(verbosity=2)

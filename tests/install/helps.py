# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the help of each command tells people: the oracle for what is made of the programs' own descriptions."""
import dataclasses
import pathlib
import re
import subprocess


@dataclasses.dataclass
class Help:
    options: dict[str, list[str]]  # name as typed -> the values that it is told to take, if it tells them
    places: list[list[str]]        # the same of the positionals
    commands: list[str]


def _section(text: str, name: str) -> list[str]:
    match = re.search(rf"^{name}:\n((?:  .*\n)*)", text, re.M)
    return [] if match is None else re.findall(r"^  (\S.*)$", match[1], re.M)


def _values(line: str) -> list[str]:
    match = re.match(r"\S+ \w+:\{([^}]*)\}", line)
    return [] if match is None else match[1].split(",")


def _read(text: str) -> Help:
    options = {name: _values(line) for line in _section(text, "Options") for name in line.split(" ")[0].split(",")}
    return Help(options, [_values(line) for line in _section(text, "Positionals")],
                [line.split(" ")[0] for line in _section(text, "Subcommands")])


def _front(text: str) -> Help:
    verbs = re.findall(r"^  ([a-z-]+) +\S", text.split("example:")[0], re.M)
    return Help({"--help": [], "--version": []}, [], verbs)


def read_helps(doorforge: pathlib.Path) -> dict[str, Help]:
    """`doorforge`, `doorforge VERB` and `doorforge VERB SUBCOMMAND` -> what their help tells."""
    def text(*words: str) -> str:
        return subprocess.run([doorforge, *words, "--help"], check=True, capture_output=True, text=True).stdout
    helps = {"doorforge": _front(text())}
    for verb in helps["doorforge"].commands:
        helps[f"doorforge {verb}"] = _read(text(verb))
        for command in helps[f"doorforge {verb}"].commands:
            helps[f"doorforge {verb} {command}"] = _read(text(verb, command))
    return helps

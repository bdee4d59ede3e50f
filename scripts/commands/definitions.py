# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs say of their commands and options, as `--describe-command` prints it."""
from __future__ import annotations

import concurrent.futures
import dataclasses
import json
import pathlib
import subprocess

DESCRIBE = "--describe-command"


@dataclasses.dataclass(frozen=True)
class Option:
    """An option, or a positional, which has one name and no dashes."""
    names: list[str]
    about: str
    type: str = ""
    check: str = ""
    values: list[str] = dataclasses.field(default_factory=list)
    default: str = ""
    needs: list[str] = dataclasses.field(default_factory=list)
    required: bool = False
    takes: int = 0
    several: bool = False

    @property
    def names_a_file(self) -> bool:
        """Whether a file or a folder may be meant: texts are, unless there is a list or a form of their own."""
        return self.takes > 0 and not self.values and self.type == "TEXT"

    @property
    def names_a_folder(self) -> bool:
        return self.check == "DIR"


@dataclasses.dataclass(frozen=True)
class Command:
    """`doorforge`, a verb or a subcommand; `words` are what is typed for it."""
    words: tuple[str, ...]
    summary: str
    about: str
    footer: str
    options: list[Option]
    positionals: list[Option]
    commands: list[Command]
    program: str = ""

    @property
    def name(self) -> str:
        return " ".join(self.words)

    def with_all_below(self) -> list[Command]:
        return [self] + [below for command in self.commands for below in command.with_all_below()]


def _described(program: pathlib.Path, *words: str) -> dict:
    command = [str(program), *words, DESCRIBE]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def _command(words: tuple[str, ...], summary: str, said: dict, program: str) -> Command:
    return Command(
        words=words, summary=summary or said["about"].split("\n")[0], about=said["about"], footer=said["footer"],
        options=[Option(**option) for option in said["options"]],
        positionals=[Option(**option) for option in said.get("positionals", [])],
        commands=[_command((*words, below["name"]), "", below, program) for below in said.get("commands", [])],
        program=program)


def read_commands(programs: pathlib.Path) -> Command:
    """All that the programs in a folder offer, as one tree below `doorforge`."""
    front = programs / "doorforge"
    said = _described(front)
    with concurrent.futures.ThreadPoolExecutor() as pool:
        descriptions = pool.map(lambda verb: _described(front, verb["name"]), said["verbs"])
    root = _command(("doorforge",), said["about"], said, "doorforge")
    for verb, described in zip(said["verbs"], descriptions):
        root.commands.append(_command(("doorforge", verb["name"]), verb["about"], described, verb["program"]))
    return root

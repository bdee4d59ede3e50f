# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line as pages in Markdown, from what the programs say of themselves."""
from __future__ import annotations

import html
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "commands"))

from definitions import Command, Option, read_commands  # noqa: E402  (the folder beside this one)
from man_pages import EXIT_CODES  # noqa: E402


def _cell(text: str) -> str:
    return html.escape(text, quote=False).replace("|", "&#124;").replace("*", "&#42;").replace("_", "&#95;").replace("\n", " ").replace("`", "&#96;")


def _code(text: str) -> str:
    return f"<code>{_cell(text)}</code>"


def _value(option: Option) -> str:
    if not option.takes:
        return ""
    value = ", ".join(option.values) if option.values else option.type
    return value + (" ..." if option.several or option.takes > 1 else "")


def _row(option: Option) -> str:
    notes = [option.about.rstrip(".") + "."]
    if option.required:
        notes.append("Required.")
    if option.needs:
        notes.append(f"With {', '.join(option.needs)}.")
    if option.default:
        notes.append(f"Default: {option.default}.")
    names = ", ".join(_code(name) for name in option.names)
    return f"| {names} | {_cell(_value(option))} | {_cell(' '.join(notes))} |"


def _table(options: list[Option]) -> list[str]:
    return ["| option | value | means |", "|---|---|---|", *map(_row, options), ""] if options else []


def _section(command: Command, level: str) -> list[str]:
    lines = [f"{level} {command.name}", "", _cell(command.about), "", *_table([*command.positionals, *command.options])]
    if command.footer:
        lines += ["```text", command.footer.strip(), "```", ""]
    for below in command.commands:
        lines += _section(below, level + "#")
    return lines


def command_pages(programs: pathlib.Path) -> dict[str, str]:
    """Name of the file -> Markdown: a page for each verb, and `index.md` with all of them."""
    root = read_commands(programs)
    index = ["# Command line", "", "Made from the programs' `--help`.", "", "| verb | does |", "|---|---|"]
    index += [f"| [{verb.words[-1]}]({verb.words[-1]}.md) | {_cell(verb.summary)} |" for verb in root.commands]
    index += ["", "## Exit codes", "", "| code | means |", "|---|---|", *(f"| {code} | {_cell(text)} |" for code, text in EXIT_CODES), ""]
    pages = {"index.md": "\n".join(index)}
    pages |= {f"{verb.words[-1]}.md": "\n".join(_section(verb, "#")) for verb in root.commands}
    return pages

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A man page for `doorforge`, for each verb, and for each program that is no verb."""
from __future__ import annotations

import re

from definitions import Command, Option

EXIT_CODES = (
    ("0", "Done."), ("1", "Findings, or items that failed."), ("2", "Wrong use, or a wrong setting."),
    ("3", "Input is missing or cannot be read."), ("4", "Incomplete: what is missing is listed."),
    ("130, 143", "Interrupted, with the state saved."))

ENVIRONMENT = (
    ("DOORFORGE_DATA", "Folder of the catalogue, the robots, the splits and the pipelines, in place of "
     "share/doorforge beside the programs."),
    ("DOORFORGE_READ_MESH", "Path of doorforge-read-mesh, in place of the one beside the programs."),
    ("DOORFORGE_READ_MODEL", "Path of doorforge-read-model, in place of the one beside the programs."),
    ("DOORFORGE_SECOND_OPINION", "Path of doorforge-second-opinion, in place of the one beside the programs."),
    ("DOORFORGE_MUJOCO", "Path of MuJoCo's library, in place of the system's, for validate."),
    ("PATH", "Only programs of one's own that link the libraries look here, for an installed doorforge."))


FILES = (
    ("share/doorforge", "Beside bin, where the programs are: catalogue, robots, splits, pipelines, trained policies and "
     "pictures to try act with. Where a help says data/, it is this folder."),
    ("share/doc/doorforge", "Pages on tasks and file formats. Where a help says docs/, it is this folder."))


def _troff(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga").replace("^", "\\(ha")
    text = text.replace("~", "\\(ti")
    return "\n".join("\\&" + line if line.startswith(".") else line for line in text.split("\n"))


def _literally(text: str) -> list[str]:
    return [".nf", _troff(text), ".fi"]


def _tagged(tag: str, text: str) -> list[str]:
    return [".TP", tag, _troff(text)]


def _section(name: str, lines: list[str]) -> list[str]:
    return [f".SH {name}", *lines] if lines else []


def _value(option: Option) -> str:
    if not option.takes:
        return ""
    value = "{" + ",".join(option.values) + "}" if option.values else option.type
    return " ".join([value] * option.takes) + (" ..." if option.several else "")


def _option(option: Option) -> list[str]:
    tag = ", ".join(f"\\fB{_troff(name)}\\fR" for name in option.names)
    value = _value(option)
    notes = []
    if option.required:
        notes.append("Required.")
    if option.check and not option.values and not option.check.isupper():
        notes.append(f"{option.check}.")
    if option.needs:
        notes.append(f"With {', '.join(option.needs)}.")
    if option.default:
        notes.append(f"Default: {option.default}.")
    return _tagged(tag + (f" \\fI{_troff(value)}\\fR" if value else ""), " ".join([option.about.rstrip(".") + ".", *notes]))


def _synopsis(command: Command) -> str:
    if command.commands:
        kind = "VERB" if len(command.words) == 1 else "SUBCOMMAND"
        return f"\\fB{_troff(command.name)}\\fR \\fI{kind}\\fR [\\fIOPTIONS\\fR]"
    places = [place.names[0] + (" ..." if place.several else "") for place in command.positionals]
    return " ".join([f"\\fB{_troff(command.name)}\\fR", "[\\fIOPTIONS\\fR]", *(f"\\fI{_troff(place)}\\fR" for place in places)])


def _subcommand(command: Command) -> list[str]:
    lines = [f".SS {_troff(' '.join(command.words[2:]))}", _synopsis(command), ".PP", _troff(command.about)]
    for option in [*command.positionals, *command.options]:
        lines += _option(option)
    return lines + ([".PP", *_literally(command.footer)] if command.footer else [])


def _parts_of_footer(footer: str) -> tuple[str, str]:
    """What is said at the end of a help, and its examples."""
    match = re.search(r"^examples?[^\n]*:\n", footer, re.M)
    return (footer, "") if match is None else (footer[:match.start()].strip(), footer[match.start():].strip())


def _page(name: str, summary: str, version: str, sections: list[str]) -> str:
    head = [f'.TH {name.upper().replace("-", chr(92) + "-")} 1 "" "doorforge {version}" "User Commands"',
            ".SH NAME", f"{_troff(name)} \\- {_troff(summary)}"]
    return "\n".join([*head, *sections]) + "\n"


def _verb_page(verb: Command, version: str) -> str:
    said, examples = _parts_of_footer(verb.footer)
    options = [line for option in [*verb.positionals, *verb.options] for line in _option(option)]
    sections = _section("SYNOPSIS", [_synopsis(verb)])
    sections += _section("DESCRIPTION", [_troff(verb.about), *([".PP", *_literally(said)] if said else [])])
    sections += _section("OPTIONS", options)
    sections += _section("SUBCOMMANDS", [line for below in verb.commands for line in _subcommand(below)])
    sections += _section("EXAMPLES", _literally(examples) if examples else [])
    sections += _section("EXIT STATUS", [line for code, text in EXIT_CODES for line in _tagged(f"\\fB{code}\\fR", text)])
    sections += _section("SEE ALSO", [".BR doorforge (1)"])
    return _page("-".join(verb.words), verb.summary, version, sections)


def _front_page(root: Command, version: str) -> str:
    sections = _section("SYNOPSIS", [_synopsis(root), ".br", "\\fBdoorforge\\fR \\fIVERB\\fR \\fB\\-\\-help\\fR"])
    sections += _section("VERBS", [line for verb in root.commands
                                   for line in _tagged(f"\\fB{_troff(verb.words[-1])}\\fR", verb.summary)])
    sections += _section("OPTIONS", [line for option in root.options for line in _option(option)])
    sections += _section("EXAMPLES", _literally(root.footer))
    sections += _section("ENVIRONMENT", [line for name, text in ENVIRONMENT for line in _tagged(f"\\fB{name}\\fR", text)])
    sections += _section("EXIT STATUS", [line for code, text in EXIT_CODES for line in _tagged(f"\\fB{code}\\fR", text)])
    sections += _section("FILES", [line for name, text in FILES for line in _tagged(f"\\fI{name}\\fR", text)])
    pages = [f".BR {_troff('-'.join(verb.words))} (1)" for verb in root.commands]
    sections += _section("SEE ALSO", [page + "," for page in pages[:-1]] + pages[-1:])
    return _page("doorforge", root.summary, version, sections)


def _program_page(program: str, verbs: list[Command], version: str) -> str:
    if verbs:
        summary = "runs verbs of doorforge"
        said = [f"Run by doorforge for {', '.join(verb.words[-1] for verb in verbs)}; not meant to be typed."]
    else:
        summary = "reads mesh files for doorforge"
        said = ["Run by the verbs of doorforge in a process of its own, with limits on memory and time, since the "
                "libraries that read such files can fail on damaged ones; not meant to be typed."]
    sections = _section("DESCRIPTION", [_troff(line) for line in said])
    sections += _section("SEE ALSO", [".BR doorforge (1)"])
    return _page(program, summary, version, sections)


def man_pages(root: Command, programs: list[str], version: str) -> dict[str, str]:
    """Name without section -> troff."""
    pages = {"doorforge": _front_page(root, version)}
    pages |= {"-".join(verb.words): _verb_page(verb, version) for verb in root.commands}
    for program in programs:
        if program not in pages:
            pages[program] = _program_page(program, [verb for verb in root.commands if verb.program == program], version)
    return pages

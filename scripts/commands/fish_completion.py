# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Completion for fish: a line for each option, which holds where its command has been typed."""
from __future__ import annotations

from definitions import Command, Option

FUNCTION = '''# Whether what is typed so far is of this command
function __doorforge_at
    set -l command doorforge
    for word in (commandline -opc)[2..]
        switch "$command $word"
            case {commands}
                set command "$command $word"
        end
    end
    test "$command" = "$argv"
end
'''


def _quoted(text: str) -> str:
    return "'" + " ".join(text.split()).replace("\\", "\\\\").replace("'", "\\'") + "'"


def _names(option: Option) -> str:
    return " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in option.names)


def _value(option: Option) -> str:
    if not option.takes:
        return ""
    if option.values:
        return f" -x -a {_quoted(' '.join(option.values))}"
    if option.names_a_folder:
        return " -x -a '(__fish_complete_directories)'"
    return " -r -F" if option.names_a_file else " -x"


def _lines(command: Command) -> list[str]:
    at = f"complete -c doorforge -n {_quoted('__doorforge_at ' + command.name)}"
    lines = [f"{at} {_names(option)}{_value(option)} -d {_quoted(option.about)}" for option in command.options]
    lines += [f"{at} -f -a {below.words[-1]} -d {_quoted(below.summary)}" for below in command.commands]
    for place in command.positionals:
        files = "-f " if place.values and len(command.positionals) == 1 else ""
        if place.values:
            lines.append(f"{at} {files}-a {_quoted(' '.join(place.values))} -d {_quoted(place.about)}")
    return lines


def fish_completion(root: Command) -> str:
    commands = " ".join(_quoted(command.name) for command in root.with_all_below()[1:])
    lines = [line for command in root.with_all_below() for line in _lines(command)]
    return "# Completion of doorforge for fish\n" + FUNCTION.format(commands=commands) + "\n" + "\n".join(lines) + "\n"

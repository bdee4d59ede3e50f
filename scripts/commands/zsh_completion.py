# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Completion for zsh: a function of `_arguments` for each command."""
from __future__ import annotations

from definitions import Command, Option


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"


def _told(text: str, special: str) -> str:
    """One line in which the characters that end a part of a specification are escaped."""
    text = " ".join(text.split()).replace("\\", "\\\\")
    for character in special:
        text = text.replace(character, "\\" + character)
    return text


def _action(option: Option) -> str:
    if option.values:
        return "(" + " ".join(option.values) + ")"
    if option.names_a_folder:
        return "_files -/"
    return "_files" if option.names_a_file else " "


def _specifications(option: Option) -> list[str]:
    """One for each name; the other names of an option that is given once are not offered any more."""
    others = "(" + " ".join(option.names) + ")" if not option.several and option.type != "KEY=VALUE" else "*"
    about = "[" + _told(option.about, "[]") + "]"
    values = f":{_told(option.type, ':')}:{_action(option)}" * option.takes
    return [others + name + ("=" if option.takes and name.startswith("--") else "") + about + values
            for name in option.names]


def _places(command: Command) -> list[str]:
    if command.commands:
        return ["1: :->command", "*:: :->below"]
    places = [("*" if place.several else str(number)) + ":" + _told(place.names[0], ":") + ":" + _action(place)
              for number, place in enumerate(command.positionals, 1)]
    further = any(option.several for option in command.options) and not any(place.startswith("*") for place in places)
    return places + (["*: :_files"] if further else [])


def _function_name(command: Command) -> str:
    return "_" + "_".join(command.words).replace("-", "_")


def _function(command: Command) -> str:
    arguments = [text for option in command.options for text in _specifications(option)] + _places(command)
    lines = [f"{_function_name(command)}() {{"]
    if command.commands:
        lines += ["  local curcontext=$curcontext state line", "  typeset -A opt_args"]
    lines += ["  _arguments -C -S : \\"] + [f"    {_quoted(text)} \\" for text in arguments[:-1]]
    lines += [f"    {_quoted(arguments[-1])}"]
    if command.commands:
        names = [_quoted(f"{below.words[-1]}:{_told(below.summary, '')}") for below in command.commands]
        lines += ["  case $state in", "    command)", "      local -a commands=("]
        lines += [f"        {name}" for name in names]
        lines += ["      )", "      _describe command commands ;;", "    below)", "      case $words[1] in"]
        lines += [f"        {below.words[-1]}) {_function_name(below)} ;;" for below in command.commands]
        lines += ["      esac ;;", "  esac"]
    return "\n".join(lines + ["}"])


def zsh_completion(root: Command) -> str:
    functions = "\n\n".join(_function(command) for command in root.with_all_below())
    return f'#compdef doorforge\n# Completion of doorforge for zsh\n\n{functions}\n\n_doorforge "$@"\n'

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Completion for bash: a table of what may follow, and one function that walks the words typed so far."""
from __future__ import annotations

import shlex

from definitions import Command, Option

FUNCTION = r'''
_doorforge() {
  local current=${COMP_WORDS[COMP_CWORD]} command=doorforge option='' left=0 place=0 word i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if [[ $word == '=' ]]; then continue; fi  # bash makes three words of --option=value
    if [[ $word == -* ]]; then
      option=$word
      left=${_doorforge_table["takes $command $option"]:-0}
    elif [[ $left == several ]]; then :
    elif ((left > 0)); then ((left -= 1))
    elif [[ " ${_doorforge_table["commands $command"]} " == *" $word "* ]]; then
      command+=" $word"
    else
      ((place += 1))
    fi
  done
  if [[ $current == '=' ]]; then current=''; fi

  local words kind
  if [[ $current == -* ]]; then
    words=${_doorforge_table["options $command"]} kind=words
  elif [[ $left != 0 ]]; then
    words=${_doorforge_table["values $command $option"]} kind=${_doorforge_table["kind $command $option"]}
  elif [[ -n ${_doorforge_table["commands $command"]} ]]; then
    words=${_doorforge_table["commands $command"]} kind=words
  else
    local last=${_doorforge_table["places $command"]:-0}
    ((place < last)) || place=$((last - 1))
    words=${_doorforge_table["values $command $place"]} kind=${_doorforge_table["kind $command $place"]}
  fi
  local IFS=$'\n'
  case $kind in
    words) COMPREPLY=($(IFS=' '; compgen -W "$words" -- "$current")) ;;
    folder) compopt -o filenames; COMPREPLY=($(compgen -d -- "$current")) ;;
    file) compopt -o filenames; COMPREPLY=($(compgen -f -- "$current")) ;;
  esac
}

complete -F _doorforge doorforge
'''


def _kind(option: Option) -> str:
    if option.values:
        return "words"
    if option.names_a_folder:
        return "folder"
    return "file" if option.names_a_file else "nothing"


def _entries(command: Command) -> dict[str, str]:
    table = {f"options {command.name}": " ".join(name for option in command.options for name in option.names)}
    if command.commands:
        table[f"commands {command.name}"] = " ".join(below.words[-1] for below in command.commands)
    if command.positionals:
        table[f"places {command.name}"] = str(len(command.positionals))
    named = [(name, option) for option in command.options for name in option.names if option.takes]
    for name, option in named:
        table[f"takes {command.name} {name}"] = "several" if option.several else str(option.takes)
    for name, option in [*named, *((str(place), option) for place, option in enumerate(command.positionals))]:
        table[f"kind {command.name} {name}"] = _kind(option)
        if option.values:
            table[f"values {command.name} {name}"] = " ".join(option.values)
    return table


def bash_completion(root: Command) -> str:
    table = {key: value for command in root.with_all_below() for key, value in _entries(command).items()}
    lines = [f"  [{shlex.quote(key)}]={shlex.quote(value)}" for key, value in table.items()]
    return "# Completion of doorforge for bash\ndeclare -gA _doorforge_table=(\n" + "\n".join(lines) + "\n)\n" + FUNCTION

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Asks real shells how they would complete lines: each takes lines and answers with the words that it offers."""
import pathlib
import shlex
import subprocess
import tempfile

# Calls the function that bash would call, with the variables that bash would set; readline alone splits at "=".
BASH = r"""
source "$1"
while IFS= read -r line; do
  read -ra COMP_WORDS <<< "${line//=/ = }"
  [[ $line == *' ' ]] && COMP_WORDS+=('')
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMP_LINE=$line COMP_POINT=${#line} COMPREPLY=()
  _doorforge doorforge "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}" 2> >(grep -v compopt >&2)
  printf '%s\t' "${COMPREPLY[@]}"; printf '\n'
done
"""

FISH = r"""
source $argv[1]
while read -l line
    set words (complete -C "$line" | string replace -r '\t.*' '')
    echo (string join -- \t $words)
end
"""

# Completion of zsh works in its line editor alone, so one is started in a terminal of its own; a widget takes the lines
# and sees what would be added to the list.
ZSH_SETUP = r"""
PS1= RPS1=
fpath=({folder} $fpath)
autoload -Uz compinit && compinit -u -D
zstyle ':completion:*' completer _complete
compadd() {{
  local -a added
  if [[ ${{@[(I)-[OAD]]}} -gt 0 ]]; then builtin compadd "$@"; return; fi
  builtin compadd -O added "$@"
  found+=("${{added[@]}}")
  (( $#added ))
}}
take() {{ found=(); _main_complete; compstate[insert]= compstate[list]=; }}
zle -C take-words complete-word take
ask() {{
  local line
  for line in "${{(@f)$(<{lines})}}"; do
    BUFFER=$line CURSOR=$#line
    zle take-words
    print -r -- "${{(pj:\t:)found}}" >> {answers}
  done
  print > {done}
  exit
}}
zle -N ask
bindkey '^T' ask
"""

ZSH = r"""
zmodload zsh/zpty
zpty shell env TERM=dumb zsh -f -i
zpty -w shell "source {setup}; print READY"
while zpty -r shell output && [[ $output != *READY* || $output == *source* ]]; do done
zpty -w -n shell $'\x14'
repeat 3000; do [[ -e {done} ]] && exit; zpty -rt shell output; sleep 0.02; done
exit 1
"""


def _answers(text: str, lines: list[str]) -> dict[str, set[str]]:
    answers = text.split("\n")[:len(lines)]
    if len(answers) < len(lines):
        raise AssertionError(f"{len(answers)} answers to {len(lines)} lines: {text[-500:]}")
    return {line: {word.strip() for word in answer.split("\t") if word.strip()} for line, answer in zip(lines, answers)}


def _asked(command: list[object], lines: list[str]) -> dict[str, set[str]]:
    done = subprocess.run([str(word) for word in command], input="\n".join(lines) + "\n", capture_output=True, text=True,
                          timeout=300)
    if done.returncode != 0 or done.stderr:
        raise AssertionError(f"exit code {done.returncode}: {done.stderr[-2000:]}")
    return _answers(done.stdout, lines)


def ask_bash(script: pathlib.Path, lines: list[str]) -> dict[str, set[str]]:
    return _asked(["bash", "--norc", "-c", BASH, "bash", script], lines)


def ask_fish(script: pathlib.Path, lines: list[str]) -> dict[str, set[str]]:
    return _asked(["fish", "--no-config", "-c", FISH, script], lines)


def ask_zsh(script: pathlib.Path, lines: list[str]) -> dict[str, set[str]]:
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "lines").write_text("\n".join(lines))
        paths = {key: shlex.quote(str(folder / key)) for key in ("lines", "answers", "done", "setup")}
        (folder / "setup").write_text(ZSH_SETUP.format(folder=shlex.quote(str(script.parent)), **paths))
        subprocess.run(["zsh", "-f", "-c", ZSH.format(**paths)], check=True, timeout=300, capture_output=True)
        return _answers((folder / "answers").read_text(), lines)


SHELLS = {"bash": ("bash/doorforge", ask_bash), "fish": ("fish/doorforge.fish", ask_fish), "zsh": ("zsh/_doorforge", ask_zsh)}

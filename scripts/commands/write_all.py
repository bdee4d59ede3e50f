# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Writes man pages and completion of the programs in a folder: write_all.py PROGRAMS VERSION OUT PROGRAM...

OUT/man1/*.1.gz, OUT/bash/doorforge, OUT/zsh/_doorforge, OUT/fish/doorforge.fish. Run by the build."""
import gzip
import pathlib
import sys

from bash_completion import bash_completion
from definitions import read_commands
from fish_completion import fish_completion
from man_pages import man_pages
from zsh_completion import zsh_completion


def main() -> None:
    programs, version, out, *names = sys.argv[1:]
    root = read_commands(pathlib.Path(programs))
    texts = {"bash/doorforge": bash_completion(root), "zsh/_doorforge": zsh_completion(root),
             "fish/doorforge.fish": fish_completion(root)}
    files = {name: text.encode() for name, text in texts.items()}
    for name, text in man_pages(root, names, version).items():
        files[f"man1/{name}.1.gz"] = gzip.compress(text.encode(), mtime=0)
    for name, content in files.items():
        path = pathlib.Path(out) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The build's version follows the commits and changes of the tree without configuring again, and its source is left
alone where nothing changed."""
import pathlib
import re
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(sys.argv[1]) / "cmake" / "write_code_version.cmake"


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        tree, source = pathlib.Path(folder, "tree"), pathlib.Path(folder, "code_version.cpp")
        tree.mkdir()

        def git(*words: str) -> str:
            return subprocess.run(["git", "-C", tree, "-c", "user.name=a", "-c", "user.email=a@b", *words],
                                  check=True, capture_output=True, text=True).stdout.strip()

        def version() -> str:
            subprocess.run(["cmake", "-D", f"SOURCE={tree}", "-D", "VERSION=1.2.3", "-D", f"OUTPUT={source}",
                            "-P", SCRIPT], check=True)
            return re.search(r'return "(.*)";', source.read_text())[1]

        def commit(text: str) -> str:
            (tree / "file").write_text(text)
            git("add", "file")
            git("commit", "-m", "a commit")
            return git("rev-parse", "HEAD")[:10]

        assert version() == "1.2.3+", "without a commit"
        git("init")
        first = commit("one")
        assert version() == f"1.2.3+{first}"
        written = source.stat().st_mtime_ns
        (tree / "untracked").write_text("")
        assert version() == f"1.2.3+{first}" and source.stat().st_mtime_ns == written, "nothing changed"
        (tree / "file").write_text("two")
        assert version() == f"1.2.3+{first}-modified"
        second = commit("two")
        assert second != first and version() == f"1.2.3+{second}"
    return 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Fails if tests that write files, the second argument says which, leave any in the folder for temporary files."""
import os
import pathlib
import subprocess
import sys
import tempfile


def main(program: str, tests: str) -> int:
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "TMPDIR": folder}
        environment.pop("TEST_TMPDIR", None)
        run = subprocess.run([program, f"--gtest_filter={tests}"], env=environment, capture_output=True, text=True, check=False)
        if run.returncode != 0 or "[  PASSED  ] 0 tests" in run.stdout:
            print(run.stdout, run.stderr, "expected tests that pass")
            return 1
        left = sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*"))
    print("\n".join(f"{program}: {tests}: left {name}" for name in left) or "nothing is left")
    return bool(left)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))

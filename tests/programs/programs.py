# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the programs share: running a verb, and real assets where they are at hand."""
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BINARY_DIR = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else SOURCE / "build/dev"
SHARED_ASSETS = SOURCE.parent / "shared/assets"


def run(*arguments: object, timeout: float = 300, memory_gib: int | None = None) -> subprocess.CompletedProcess:
    """Runs `doorforge ARGUMENTS`. A hang ends in TimeoutExpired; more memory than allowed is not to be had."""
    command = [str(BINARY_DIR / "bin/doorforge"), *map(str, arguments)]
    limit = None if memory_gib is None else lambda: resource.setrlimit(resource.RLIMIT_AS, (memory_gib << 30,) * 2)
    return subprocess.run(command, capture_output=True, text=True, timeout=timeout, errors="replace", preexec_fn=limit)


def real_assets(group: str) -> pathlib.Path:
    """Folder with an unpacked group of real assets; skips the test where there are none."""
    if not (SHARED_ASSETS / "unpack.sh").exists():
        raise unittest.SkipTest(f"no real assets beside the checkout ({SHARED_ASSETS})")
    target = BINARY_DIR / "real_assets"
    subprocess.run(["bash", SHARED_ASSETS / "unpack.sh", target, group], check=True, capture_output=True)
    return target


class ProgramTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(dir=BINARY_DIR)
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def assert_ends(self, result: subprocess.CompletedProcess, *codes: int) -> None:
        context = f"{result.args}\nexit code {result.returncode}\n{result.stdout[-2000:]}\n{result.stderr[-2000:]}"
        self.assertIn(result.returncode, codes, context)

    def assert_refused(self, result: subprocess.CompletedProcess, *codes: int) -> None:
        """A message on stderr that names the problem, one of the exit codes, and no crash."""
        self.assert_ends(result, *codes)
        self.assertIn("doorforge", result.stderr, result.args)
        self.assertGreater(len(result.stderr.strip()), 20, result.args)

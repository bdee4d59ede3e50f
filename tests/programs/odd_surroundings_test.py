# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Names that no sane person gives (quotes, markup, line breaks, bytes that are no UTF-8, more than the system takes), two
programs on one output, and a wall clock that jumps by years: the work is done as everywhere else, or refused by name."""
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import unittest

SHIM = pathlib.Path(sys.argv.pop(2)).resolve() if len(sys.argv) > 2 and sys.argv[2].endswith(".so") else None
from programs import BINARY_DIR, ProgramTest
from sound_inputs import BODY, HANDLE

DOORFORGE = (BINARY_DIR / "bin/doorforge").resolve()
# the first ends an element of a page where it meets the name of a folder in it
NAMES = (b"quote'\"<b>&amp;$(touch broken)`touch broken`%s<", b"line\nbreak\r\tand \x07 bell", b"not utf8 \xff\xfe\xc0")
INNER = b"script><b>bold"
AS_MARKUP = ("<b>&amp;$(touch", "</script><b>bold")


def run(*arguments: object, **more: object) -> subprocess.CompletedProcess:
    return subprocess.run([DOORFORGE, *(os.fspath(a) if isinstance(a, os.PathLike) else str(a) for a in arguments)],
                          capture_output=True, timeout=300, **more)


def digests(folder: pathlib.Path) -> dict[str, str]:
    return {os.fspath(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class OddTest(ProgramTest):
    def done(self, *arguments: object) -> subprocess.CompletedProcess:
        result = run(*arguments, cwd=self.folder)
        self.assertEqual(result.returncode, 0, (arguments, result.stdout[-500:], result.stderr[-1500:]))
        return result

    def setUp(self) -> None:
        super().setUp()
        self.folder = self.folder.resolve()

    def door(self, out: pathlib.Path) -> pathlib.Path:
        self.done("compose", "--body", BODY, "--handle", HANDLE, "--out", out)
        return out


class OddNames(OddTest):
    def folders(self) -> list[pathlib.Path]:
        folders = [self.folder / os.fsdecode(name) / os.fsdecode(INNER) for name in NAMES]
        for folder in folders:
            folder.mkdir(parents=True)
        return folders

    def tearDown(self) -> None:
        self.assertEqual([path for path in self.folder.rglob("broken")], [], "a shell has read a name")

    def test_pages_show_the_name_as_text(self):
        for folder in self.folders():
            door = self.door(folder / "door")
            self.done("view", door, "--out", folder / "page.html")
            data = folder / "data"
            self.done("datagen", "open", "--doors", door, "--episodes", 2, "--seed", 3, "--set", "cloud.point_count=64", "--out", data)
            self.done("dataset", "info", data, "--html", folder / "data.html")
            self.done("dataset", "verify", data)
            self.done("eval", "--opener", "expert", "--doors", door, "--seeds", 1, "--set", "expert_reference=false", "--out", folder / "report")
            for page in (folder / "page.html", folder / "data.html", folder / "report/report.html"):
                content = page.read_bytes().decode("utf-8")  # throws where it is no UTF-8
                for markup in AS_MARKUP:
                    self.assertNotIn(markup, content, page)
            for record in (folder / "report/report.json", data / "provenance.json"):
                json.loads(record.read_bytes().decode("utf-8"))

    def test_a_slurm_script_takes_the_name_or_refuses_it(self):
        for folder in self.folders():
            door = self.door(folder / "door")
            script = folder / "job.sh"
            result = run("datagen", "open", "--doors", door, "--episodes", 2, "--seed", 3, "--set", "cloud.point_count=64", "--set",
                         "collection.episodes_per_shard=1", "--set", "preview=false", "--out", folder / "data", "--slurm", script, "--tasks", 2)
            if b"\n" in os.fsencode(folder):
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(b"line break", result.stderr)
                self.assertFalse(script.exists())
                continue
            self.assertEqual(result.returncode, 0, result.stderr)
            for task in "01":
                ran = subprocess.run(["bash", script, "task", "0"], capture_output=True, cwd=self.folder,
                                     env=dict(os.environ, SLURM_ARRAY_TASK_ID=task, SLURM_ARRAY_TASK_COUNT="2"))
                self.assertEqual(ran.returncode, 0, ran.stderr)
            for role in ("merge", "verify"):
                ran = subprocess.run(["bash", script, role], capture_output=True, cwd=self.folder)
                self.assertEqual(ran.returncode, 0, ran.stderr)

    def test_a_name_that_the_system_does_not_take_is_refused(self):
        door = self.door(self.folder / "door")
        for name in ("n" * 256, "/".join(["deep"] * 820)):  # 255 bytes a name, 4,096 a path
            out = self.folder / name
            for command in (["compose", "--body", BODY, "--handle", HANDLE, "--out", out], ["view", door, "--out", out],
                            ["export", door, "--to", "urdf", "--out", out], ["preview", door, "--out", out],
                            ["datagen", "open", "--doors", door, "--episodes", 1, "--out", out],
                            ["eval", "--opener", "expert", "--doors", door, "--seeds", 1, "--out", out],
                            ["validate", out], ["dataset", "verify", out], ["catalog", "build", "--category", "safe", "--out", out]):
                result = run(*command)
                self.assertIn(result.returncode, (2, 3), (command[0], result.stderr[-500:]))
                self.assertIn(name[:40].encode(), result.stderr, command[0])
                self.assertNotIn(b"unexpected", result.stderr, command[0])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["door"])


class TwoAtOnce(OddTest):
    """Those that take no lock, since what they write appears under its name when it is whole: the second is refused or
    ends alike, and what lies there is one of theirs."""
    def two(self, command: list, out: pathlib.Path) -> None:
        self.done(*command, "--out", self.folder / "alone")
        for _ in range(1):
            both = [subprocess.Popen([DOORFORGE, *map(str, command), "--out", out], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                    for _ in range(2)]
            told = [process.communicate()[1] for process in both]
            codes = sorted(process.returncode for process in both)
            self.assertEqual(codes[0], 0, told)
            self.assertIn(codes[1], (0, 1, 2, 3), told)
            if out.is_dir():
                self.assertEqual(self.comparable(digests(out)), self.comparable(digests(self.folder / "alone")), told)
                subprocess.run(["rm", "-rf", out], check=True)
            else:
                self.assertEqual(out.read_bytes(), (self.folder / "alone").read_bytes())

    @staticmethod
    def comparable(found: dict[str, str]) -> dict[str, str]:
        return {name: digest for name, digest in found.items() if not name.startswith("report")}  # these name their folder

    def test_compose(self):
        self.two(["compose", "--body", BODY, "--handle", HANDLE], self.folder / "out")

    def test_export(self):
        self.two(["export", self.door(self.folder / "door"), "--format", "mjcf,urdf"], self.folder / "out")

    def test_eval(self):
        door = self.door(self.folder / "door")
        self.two(["eval", "--opener", "expert", "--doors", door, "--seeds", 1, "--set", "expert_reference=false"], self.folder / "out")


class JumpingClock(OddTest):
    def test_what_is_written_is_the_same(self):
        jumping = dict(os.environ, LD_PRELOAD=str(SHIM), FAULTY_CLOCK="1")
        says = subprocess.run(["/usr/bin/python3", "-c", "import time; print(abs(time.time() - time.time()) > 1e8)"], env=jumping,
                              capture_output=True, text=True)
        self.assertEqual(says.stdout.strip(), "True", "the clock does not jump")
        for name, environment in (("sound", None), ("jumping", jumping)):
            out = self.folder / name
            out.mkdir()
            for command in (["compose", "--body", BODY, "--handle", HANDLE, "--out", out / "door"],
                            ["datagen", "open", "--doors", out / "door", "--episodes", 2, "--seed", 3, "--set", "cloud.point_count=64", "-j", 1,
                             "--out", out / "data"],
                            ["datagen", "open", "--doors", out / "door", "--episodes", 2, "--seed", 3, "--set", "cloud.point_count=64", "-j", 1,
                             "--out", out / "data"],
                            ["dataset", "status", out / "data"], ["dataset", "verify", out / "data"],
                            ["eval", "--opener", "expert", "--doors", out / "door", "--seeds", 1, "--set", "expert_reference=false",
                             "--out", out / "report"]):
                result = run(*command, env=environment)
                self.assertEqual(result.returncode, 0, (shlex.join(map(str, command)), result.stderr))
        for part in ("door", "data"):
            self.assertEqual(digests(self.folder / "jumping" / part), digests(self.folder / "sound" / part))


if __name__ == "__main__":
    unittest.main(verbosity=2)

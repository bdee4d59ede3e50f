# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Every operation by which a program changes the disk fails once: refused (EIO, EACCES, EINTR), no more room, half of a
write taken, killed before it, the power cut before it. Then the message names what could not be written, nothing half is
under a final name, nothing is left, and the same command, told to go on or to overwrite, ends with the bytes of a run that
nobody disturbed.

    writer_faults_test.py BUILD_FOLDER SHIM       a few operations of each writer, as continuous integration does
    DOORFORGE_FAULTS=all writer_faults_test.py BUILD_FOLDER SHIM [Faults.test_compose ...]    all operations in all ways;
                                                  a number: so many of each writer

SHIM is what faulty_io.cpp becomes. DOORFORGE_LEROBOT_PYTHON names a Python with pyarrow for the export to lerobot.
"""
import collections
import dataclasses
import functools
import hashlib
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

SHIM = pathlib.Path(sys.argv.pop(2)).absolute() if len(sys.argv) > 2 and sys.argv[2].endswith(".so") else None
from programs import BINARY_DIR, ProgramTest
from sound_inputs import BODY, CONFIGS, HANDLE, write_object, write_small_catalogue

WANTED = os.environ.get("DOORFORGE_FAULTS", "")
SHIM = SHIM or (BINARY_DIR / "tests/programs/libfaulty_io.so").absolute()
COLLECT = ("--episodes", 1, "--seed", 3, "--set", "cloud.point_count=64", "--set", "preview=false")
KINDS = {  # what can befall which operation
    "open": ("EIO", "EACCES", "EINTR", "ENOSPC", "kill", "power"), "write": ("EIO", "EINTR", "ENOSPC", "short", "kill", "power"),
    "truncate": ("EIO", "EINTR", "kill"), "sync": ("EIO", "EINTR", "ENOSPC", "kill", "power"),
    "syncfs": ("EIO", "kill", "power"), "rename": ("EIO", "EACCES", "ENOSPC", "kill", "power"),
    "exchange": ("EIO", "kill", "power"), "link": ("EIO", "EACCES", "ENOSPC", "kill"),
    "mkdir": ("EIO", "EACCES", "ENOSPC", "kill"), "remove": ("EIO", "EACCES", "kill")}
HARMLESS = ("EINTR", "short")  # what a program may simply do again
LOCK = ".writing"  # tells others who writes; what it says is for a message alone
WORDS = ("unexpected, please report", "terminate called", "filesystem error", "basic_")


def digests(folder: pathlib.Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


@dataclasses.dataclass(frozen=True)
class Operation:
    name: str
    paths: tuple[str, ...]


@dataclasses.dataclass
class Writer:
    """A command, below whose folder everything that it changes lies."""
    command: list
    again: tuple = ("--overwrite",)  # what it is given besides when it is given once more
    begun: pathlib.Path | None = None  # what lies in the folder before
    runs: int = 8  # of continuous integration
    volatile: tuple[str, ...] = ()  # files that hold times
    partial: tuple[str, ...] = ()  # files that grow, or are replaced, while it works
    done: int = 0  # with which it ends where nothing befalls it
    codes: tuple[int, ...] = (3,)  # with which it may end where something could not be written; 1: a batch that left one out
    tried: tuple[str, ...] = ()  # files that a library opens on trial first, whose refusal means nothing


class Faults(ProgramTest):
    @classmethod
    def setUpClass(cls) -> None:
        if not SHIM.is_file():
            raise AssertionError(f"{SHIM}: no such file, so no operation would fail")
        folder = tempfile.TemporaryDirectory(dir=BINARY_DIR)
        cls.addClassCleanup(folder.cleanup)
        cls.inputs = pathlib.Path(folder.name).resolve()
        cls.door = cls.inputs / "door"
        cls.make("compose", "--body", BODY, "--handle", HANDLE, "--out", cls.door)

    # ---- inputs, each made once ----

    @classmethod
    def make(cls, *arguments: object) -> None:
        result = cls.run_below(cls.inputs, list(arguments), -1, "")
        if result.returncode != 0:
            raise AssertionError(f"{arguments}: {result.stderr}")

    @classmethod
    @functools.cache
    def data(cls, points: int = 64) -> pathlib.Path:
        out = cls.inputs / f"data_{points}"
        cls.make("datagen", "open", "--doors", cls.door, *COLLECT, "--set", f"cloud.point_count={points}", "--out", out)
        return out

    @classmethod
    @functools.cache
    def small_catalogue(cls) -> pathlib.Path:
        write_small_catalogue(cls.inputs / "catalogue")
        return cls.inputs / "catalogue"

    def use_small_catalogue(self) -> None:
        patch = unittest.mock.patch.dict(os.environ, DOORFORGE_DATA=str(self.small_catalogue()))
        patch.start()
        self.addCleanup(patch.stop)

    # ---- running a writer ----

    def setUp(self) -> None:
        super().setUp()
        self.began = time.monotonic()
        self.folder = self.folder.resolve()
        self.root = self.folder / "root"
        self.state, self.log = self.folder / "root.state", self.folder / "root.log"

    @staticmethod
    def run_below(root: pathlib.Path, command: list, at: int, kind: str) -> subprocess.CompletedProcess:
        """Beside `root` are then the log and the count of its operations."""
        state, log = root.with_name(root.name + ".state"), root.with_name(root.name + ".log")
        state.write_bytes(struct.pack("q", 0))
        log.unlink(missing_ok=True)
        environment = dict(os.environ, LD_PRELOAD=str(SHIM), FAULTY_ROOT=str(root), FAULTY_STATE=str(state),
                           FAULTY_LOG=str(log), FAULTY_AT=str(at), FAULTY_KIND="kill" if kind == "power" else kind)
        return subprocess.run([str(BINARY_DIR / "bin/doorforge"), *map(str, command)], capture_output=True, text=True,
                              errors="replace", timeout=600, env=environment)

    def run_with(self, command: list, at: int, kind: str) -> subprocess.CompletedProcess:
        result = self.run_below(self.root, command, at, kind)
        self.assertGreater(struct.unpack("q", self.state.read_bytes())[0], at, f"the operation was not reached\n{result.stderr}")
        return result

    def operations(self) -> list[Operation]:
        rows = [line.split("\t") for line in self.log.read_text(errors="replace").splitlines()] if self.log.exists() else []
        return [Operation(row[0], tuple(row[1:-1])) for row in rows]

    def begin(self, writer: Writer) -> None:
        shutil.rmtree(self.root, ignore_errors=True)
        self.root.mkdir()
        if writer.begun:
            shutil.copytree(writer.begun, self.root, dirs_exist_ok=True, symlinks=True)

    def cut_power(self) -> None:
        """What no sync has seen is lost, but for the names, which the disk may have written already."""
        synced: dict[str, int] = {}
        for operation in self.operations():
            path = operation.paths[0]
            if operation.name == "open":
                synced.setdefault(path, 0)
            elif operation.name == "sync" and path in synced:
                synced[path] = 1 << 62
            elif operation.name == "write" and path in synced:
                synced[path] = 0  # all of it: what was synced before is overwritten or grows
            elif operation.name == "syncfs":
                synced = {name: 1 << 62 for name in synced}
            elif operation.name in ("rename", "exchange"):
                old, new = operation.paths
                moved = {new + name[len(old):]: size for name, size in synced.items() if name == old or name.startswith(old + "/")}
                synced = {name: size for name, size in synced.items() if name != old and not name.startswith(old + "/")} | moved
        for name, size in synced.items():
            if os.path.isfile(name) and os.path.getsize(name) > size:
                os.truncate(name, size)

    def judge(self, writer: Writer, whole: dict[str, str], begun: dict[str, str], operation: Operation, kind: str,
              result: subprocess.CompletedProcess) -> None:
        told = f"{kind} of {operation}\n{result.returncode}\n{result.stdout[-500:]}\n{result.stderr[-1500:]}"
        there = digests(self.root)
        if operation.name == "remove":  # what could not be removed is in the way of nothing: the next writer does it
            there = {name: digest for name, digest in there.items() if not self.is_hidden(name)}
        if kind in ("kill", "power"):
            self.assertNotEqual(result.returncode, writer.done, told)
        else:
            allowed = (writer.done, *writer.codes)
            self.assertIn(result.returncode, allowed, told)
            for word in WORDS:
                self.assertNotIn(word, result.stderr, told)
            if result.returncode == writer.done:
                was_tried = operation.name == "open" and self.matches(operation.paths[0], writer.tried)
                forgivable = kind in HARMLESS or operation.name == "remove" or LOCK in operation.paths[0] or was_tried
                self.assertTrue(forgivable, told)
                self.assertEqual(self.compared(writer, there), self.compared(writer, whole), told)
            else:
                self.assertIn(str(self.root), result.stderr + result.stdout, told)
                self.assertRegex(result.stderr + result.stdout, "Input/output error|Permission denied|No space left|Interrupted system call", told)
            self.assertEqual([name for name in there if ".tmp-" in name], [], told)
        for name, digest in there.items():
            if not self.is_hidden(name) and not self.matches(name, writer.volatile + writer.partial):
                self.assertIn(digest, (whole.get(name), begun.get(name)), f"{name}: half\n{told}")

    @staticmethod
    def is_hidden(name: str) -> bool:
        return any(part.startswith(".") for part in pathlib.Path(name).parts)

    @staticmethod
    def matches(name: str, patterns: tuple[str, ...]) -> bool:
        return any(pathlib.PurePath(name).match(pattern) for pattern in patterns)

    def compared(self, writer: Writer, found: dict[str, str]) -> dict[str, str]:
        return {name: digest for name, digest in found.items() if not self.matches(name, writer.volatile)}

    def sweep(self, writer: Writer) -> None:
        self.begin(writer)
        begun = digests(self.root)
        self.assert_ends(self.run_with(writer.command, -1, ""), writer.done)
        whole = digests(self.root)
        operations = self.operations()
        pairs = [(at, kind) for at, operation in enumerate(operations) for kind in KINDS[operation.name]]
        self.assertTrue(pairs, "no operation was seen")
        runs = int(WANTED) if WANTED.isdigit() else writer.runs
        chosen = pairs if WANTED == "all" else self.chosen(pairs, operations, runs)
        for at, kind in chosen:
            with self.subTest(f"{at} {operations[at].name} {kind}"):
                self.begin(writer)
                result = self.run_with(writer.command, at, kind)
                self.judge(writer, whole, begun, operations[at], kind, result)
                if kind == "power":
                    self.cut_power()
                if result.returncode != writer.done or operations[at].name == "remove":
                    self.check_again(writer, whole, f"{kind} of {operations[at]}\n{result.stderr[-500:]}")
        counts = collections.Counter(operation.name for operation in operations)
        print(f"{self.id().split('.')[-1]}: {len(operations)} operations {dict(counts)}, {len(chosen)} of {len(pairs)} faults, "
              f"{time.monotonic() - self.began:.1f} s", flush=True)

    def check_again(self, writer: Writer, whole: dict[str, str], told: str) -> None:
        again = self.run_with([*writer.command, *writer.again], -1, "")
        self.assert_ends(again, writer.done)
        self.assertEqual(self.compared(writer, digests(self.root)), self.compared(writer, whole), f"{told}\n{again.stderr[-500:]}")

    @staticmethod
    def chosen(pairs: list, operations: list[Operation], count: int) -> list:
        """Some of them, each kind of operation and of fault as often as another."""
        left = list(pairs)
        random.Random(5).shuffle(left)
        seen: collections.Counter = collections.Counter()
        taken = []
        while left and len(taken) < count:
            best = min(left, key=lambda pair: seen["operation", operations[pair[0]].name] + seen["kind", pair[1]])
            left.remove(best)
            taken.append(best)
            seen["operation", operations[best[0]].name] += 1
            seen["kind", best[1]] += 1
        return sorted(taken)

    # ---- the writers ----

    def test_compose(self):
        self.sweep(Writer(["compose", "--body", BODY, "--handle", HANDLE, "--out", self.root / "door"], runs=4))

    def test_compose_replaces(self):
        old = self.folder / "old"
        shutil.copytree(self.door, old / "door")
        self.sweep(Writer(["compose", "--body", BODY, "--handle", HANDLE, "--set", "leaf_width_m=0.8", "--out", self.root / "door",
                           "--overwrite"], again=(), begun=old, runs=3))

    def test_compose_all(self):
        parts = self.folder / "parts"
        self.use_small_catalogue()
        self.make("catalog", "build", "--out", parts)
        self.sweep(Writer(["compose", "--all", "-j", 1, "--parts", parts, "--out", self.root / "doors"], runs=3, codes=(1, 3),
                          partial=("pool.json", "door_index.json")))

    def test_catalog(self):
        self.use_small_catalogue()
        self.sweep(Writer(["catalog", "build", "-j", 1, "--out", self.root / "parts"], runs=3, codes=(1, 3)))

    def test_import(self):
        objects = self.folder / "objects"
        write_object(objects / "cupboard", "cupboard.urdf")
        self.sweep(Writer(["import", objects, "--category", "storagefurniture", "--out", self.root / "parts"], runs=3, codes=(1, 3, 4)))

    def test_export(self):
        self.sweep(Writer(["export", self.door, "--format", "mjcf,sdf,glb,usda,urdf", "--out", self.root / "exports"], runs=3,
                          codes=(1, 3)))

    def test_eval(self):
        self.sweep(Writer(["eval", "--opener", "expert", "--doors", self.door, "--seeds", 1, "--set", "expert_reference=false",
                           "--set", "scene.physics.max_opening_actions=4", "--films", "--out", self.root / "report", "--overwrite"],
                          again=(), runs=1))  # the report holds its command

    def test_simulate_film(self):
        self.sweep(Writer(["simulate", "--door", self.door, "--seeds", 1, "--set", "scene.physics.max_opening_actions=4", "--film",
                           self.root / "film"], runs=1, done=1))  # it opens no door within so few actions

    def test_datagen(self):
        self.sweep(Writer(["datagen", "open", "--doors", self.door, *COLLECT, "-j", 1, "--out", self.root / "data"], again=(),
                          runs=3, partial=("*",)))

    def test_card(self):
        begun = self.folder / "begun"
        shutil.copytree(self.data(), begun / "data")
        self.sweep(Writer(["dataset", "card", self.root / "data"], begun=begun, runs=2, partial=("SHA256SUMS",)))

    def test_merge(self):
        self.sweep(Writer(["dataset", "merge", self.root / "merged", self.data()], again=(), runs=2, partial=("SHA256SUMS",)))

    def test_robomimic(self):
        self.sweep(Writer(["dataset", "export", self.data(), "--to", "robomimic", "--out", self.root / "data.hdf5"], runs=6, tried=("data.hdf5",)))

    def test_train(self):
        self.sweep(Writer(["train", "open", "--data", self.data(4096), "--out", self.root / "policy", "--set", "batch_size=8", "--seed", 1,
                           "--epochs", 1], again=("--resume",), runs=1, volatile=("losses.jsonl", "training.html"), partial=("*",)))

    def test_repair(self):
        mesh = sorted((self.door / "meshes/visual").rglob("*.obj"))[0]
        self.sweep(Writer(["repair", mesh, self.root / "mesh.obj"], runs=2))

    def test_pages(self):
        self.sweep(Writer(["view", self.door, "--out", self.root / "page.html"], runs=2))

    def test_preview(self):
        self.sweep(Writer(["preview", self.door, "--focus", "whole", "--width", 32, "--out", self.root / "picture.png"], runs=2))

    def test_pipeline(self):
        declared = self.folder / "two.yaml"
        declared.write_text(CONFIGS["configs/tested_pipeline.yaml"])
        self.use_small_catalogue()
        self.sweep(Writer(["pipeline", declared, "--out", self.root / "run"], again=(), runs=1, partial=("*",), codes=(3, 4)))

    def test_benchmark(self):
        """Whose steps have run: they are programs of their own."""
        doors = self.folder / "doors"
        for body, handle in (("interior_planked_01", "interior_lever_cranked_03"), ("storage_arched_corner_01", "storage_knob_ball_01")):
            self.make("compose", "--body", body, "--handle", handle, "--out", doors / body)
        command = ["benchmark", "quick", "--out", self.root / "bench", "--doors", doors, "--rows", "expert", "--set", "seeds=1"]
        self.root.mkdir()
        self.assert_ends(self.run_with(command, -1, ""), 0)
        begun = self.root.rename(self.folder / "begun")
        for page in list((begun / "bench").glob("benchmark.*")):
            page.unlink()
        self.sweep(Writer(command, again=(), begun=begun, runs=3, partial=("*",), codes=(3, 4)))

    if "DOORFORGE_LEROBOT_PYTHON" in os.environ:  # Python and pyarrow write it, not these programs

        def test_lerobot(self):
            self.sweep(Writer(["dataset", "export", self.data(), "--to", "lerobot", "--python", os.environ["DOORFORGE_LEROBOT_PYTHON"],
                               "--out", self.root / "lerobot"]))


class Shim(ProgramTest):
    """Without faults the test of faults fails."""
    def test_what_injects_nothing_is_told(self):
        idle = self.folder / "idle.so"
        shutil.copy("/lib/x86_64-linux-gnu/libm.so.6", idle)
        for shim, said in ((idle, "no operation was seen"), (self.folder / "missing.so", "no such file")):
            result = subprocess.run([sys.executable, __file__, str(BINARY_DIR), str(shim), "Faults.test_pages"], capture_output=True, text=True)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(said, result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

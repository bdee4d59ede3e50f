# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Every operation by which a program changes the disk fails once: refused (EIO, EACCES, EINTR), no more room, half of a
write taken, killed before it, the power cut before it. Then the message names what could not be written, nothing half is
under a final name, nothing is left, and the same command, told to go on or to overwrite, ends with the bytes of a run that
nobody disturbed.

    writer_faults_test.py BUILD_FOLDER            a few operations of each writer, as continuous integration does
    DOORFORGE_FAULTS=all writer_faults_test.py BUILD_FOLDER [Faults.test_compose ...]    all operations in all ways
"""
import collections
import dataclasses
import hashlib
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

SHIM = pathlib.Path(sys.argv.pop(2)).resolve() if len(sys.argv) > 2 and sys.argv[2].endswith(".so") else None
from programs import BINARY_DIR, SOURCE, ProgramTest, run
from sound_inputs import BODY, HANDLE, write_object

PIPELINE = """schema: doorforge.pipeline
schema_version: 1
about: two steps
settings:
  seed: 7
steps:
  - name: parts
    does: Parts
    command: [catalog, build, --out, "{parts}", --threads, "{threads}"]
    output: parts
    records: [part.json]
    core_seconds: {fixed: 5}
    mebibytes: {fixed: 5}
  - name: doors
    needs: [parts]
    does: Doors
    command: [compose, --all, --parts, "{parts}", --out, "{doors}", --set, "seed={seed}"]
    output: doors
    records: [door.json]
    resume: ""
    core_seconds: {seed: 0.2}
    mebibytes: {fixed: 1}
"""
ALL = os.environ.get("DOORFORGE_FAULTS") == "all"
SHIM = SHIM or (BINARY_DIR / "lib/libfaulty_io.so").resolve()
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
    codes: tuple[int, ...] = (3,)  # with which it may end where something could not be written; 1: a batch that left one out


class Faults(ProgramTest):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(dir=BINARY_DIR)
        cls.addClassCleanup(folder.cleanup)
        cls.inputs = pathlib.Path(folder.name).resolve()
        cls.door = cls.inputs / "door"
        cls.make("compose", "--body", BODY, "--handle", HANDLE, "--out", cls.door)

    @classmethod
    def make(cls, *arguments: object) -> None:
        result = run(*arguments)
        if result.returncode != 0:
            raise AssertionError(f"{arguments}: {result.stderr}")

    def setUp(self) -> None:
        super().setUp()
        self.folder = self.folder.resolve()
        self.root = self.folder / "root"
        self.state, self.log = self.folder / "state", self.folder / "log"

    def run_with(self, command: list, at: int, kind: str) -> subprocess.CompletedProcess:
        self.state.write_bytes(struct.pack("q", 0))
        self.log.unlink(missing_ok=True)
        environment = dict(os.environ, LD_PRELOAD=str(SHIM), FAULTY_ROOT=str(self.root), FAULTY_STATE=str(self.state),
                           FAULTY_LOG=str(self.log), FAULTY_AT=str(at), FAULTY_KIND="kill" if kind == "power" else kind)
        return subprocess.run([str(BINARY_DIR / "bin/doorforge"), *map(str, command)], capture_output=True, text=True,
                              errors="replace", timeout=600, env=environment)

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
            there = {name: digest for name, digest in there.items() if ".tmp-" not in name}
        if kind in ("kill", "power"):
            self.assertNotEqual(result.returncode, 0, told)
        else:
            allowed = (0, *writer.codes)
            self.assertIn(result.returncode, allowed, told)
            for word in WORDS:
                self.assertNotIn(word, result.stderr, told)
            if result.returncode == 0:
                forgivable = kind in HARMLESS or operation.name == "remove" or LOCK in operation.paths[0]
                self.assertTrue(forgivable, told)
                self.assertEqual(self.compared(writer, there), self.compared(writer, whole), told)
            else:
                self.assertIn(str(self.root), result.stderr + result.stdout, told)
                self.assertRegex(result.stderr + result.stdout, "Input/output error|Permission denied|No space left|Interrupted system call", told)
            self.assertEqual([name for name in there if ".tmp-" in name], [], told)
        for name, digest in there.items():
            is_final = not any(part.startswith(".") for part in pathlib.Path(name).parts)
            if is_final and not self.matches(name, writer.volatile + writer.partial):
                self.assertIn(digest, (whole.get(name), begun.get(name)), f"{name}: half\n{told}")

    @staticmethod
    def matches(name: str, patterns: tuple[str, ...]) -> bool:
        return any(pathlib.PurePath(name).match(pattern) for pattern in patterns)

    def compared(self, writer: Writer, found: dict[str, str]) -> dict[str, str]:
        return {name: digest for name, digest in found.items() if not self.matches(name, writer.volatile)}

    def sweep(self, writer: Writer) -> None:
        self.begin(writer)
        begun = digests(self.root)
        self.assert_ends(self.run_with(writer.command, -1, ""), 0)
        whole = digests(self.root)
        operations = self.operations()
        pairs = [(at, kind) for at, operation in enumerate(operations) for kind in KINDS[operation.name]]
        chosen = pairs if ALL else self.chosen(pairs, operations, writer.runs)
        for at, kind in chosen:
            with self.subTest(f"{at} {operations[at].name} {kind}"):
                self.begin(writer)
                result = self.run_with(writer.command, at, kind)
                self.judge(writer, whole, begun, operations[at], kind, result)
                if kind == "power":
                    self.cut_power()
                again = run(*writer.command, *writer.again)
                self.assert_ends(again, 0)
                self.assertEqual(self.compared(writer, digests(self.root)), self.compared(writer, whole),
                                 f"{kind} of {operations[at]}\n{result.stderr[-500:]}\n{again.stderr[-500:]}")
        counts = collections.Counter(operation.name for operation in operations)
        print(f"{self.id().split('.')[-1]}: {len(operations)} operations {dict(counts)}, {len(chosen)} of {len(pairs)} faults", flush=True)

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

    def use_small_catalogue(self) -> None:
        """Of a body and a handle."""
        data = self.folder / "catalogue_data"
        shutil.copytree(SOURCE / "data/families", data / "families")
        for name in ("safe_antique_01", "safe_dial_lever_01"):
            recipe = next((SOURCE / "data/catalog").rglob(f"{name}.yaml"))
            target = data / "catalog" / recipe.relative_to(SOURCE / "data/catalog")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(recipe, target)
        patch = unittest.mock.patch.dict(os.environ, DOORFORGE_DATA=str(data))
        patch.start()
        self.addCleanup(patch.stop)

    # ---- the writers ----

    def test_compose(self):
        self.sweep(Writer(["compose", "--body", BODY, "--handle", HANDLE, "--out", self.root / "door"], runs=6))

    def test_compose_replaces(self):
        old = self.folder / "old"
        shutil.copytree(self.door, old / "door")
        self.sweep(Writer(["compose", "--body", BODY, "--handle", HANDLE, "--set", "leaf_width_m=0.8", "--out", self.root / "door",
                           "--overwrite"], again=(), begun=old, runs=5))

    def test_compose_all(self):
        parts = self.folder / "parts"
        self.use_small_catalogue()
        self.make("catalog", "build", "--out", parts)
        self.sweep(Writer(["compose", "--all", "-j", 1, "--parts", parts, "--out", self.root / "doors"], runs=5, codes=(1, 3), partial=("pool.json", "door_index.json")))

    def test_catalog(self):
        self.use_small_catalogue()
        self.sweep(Writer(["catalog", "build", "-j", 1, "--out", self.root / "parts"], runs=3, codes=(1, 3)))

    def test_import(self):
        objects = self.folder / "objects"
        write_object(objects / "cupboard", "cupboard.urdf")
        self.sweep(Writer(["import", objects, "--category", "storagefurniture", "--out", self.root / "parts"], runs=4, codes=(1, 3, 4)))

    def test_export(self):
        self.sweep(Writer(["export", self.door, "--format", "mjcf,sdf,glb,usda,urdf", "--out", self.root / "exports"], runs=4,
                          codes=(1, 3)))

    def test_eval(self):
        self.sweep(Writer(["eval", "--opener", "expert", "--doors", self.door, "--seeds", 1, "--set", "expert_reference=false",
                           "--set", "scene.physics.max_opening_actions=4", "--films", "--out", self.root / "report", "--overwrite"],
                          again=(), runs=3))  # the report holds its command

    def data(self, points: int = 64) -> pathlib.Path:
        out = self.folder / "data"
        self.make("datagen", "open", "--doors", self.door, "--episodes", 2, "--seed", 3, "--set", f"cloud.point_count={points}",
                  "--set", "preview=false", "--out", out)
        return out

    def test_datagen(self):
        self.sweep(Writer(["datagen", "open", "--doors", self.door, "--episodes", 2, "--seed", 3, "--set", "cloud.point_count=64",
                           "--set", "preview=false", "-j", 1, "--out", self.root / "data"], again=(), runs=3, partial=("*",)))

    def test_card(self):
        data = self.data()
        begun = self.folder / "begun"
        shutil.copytree(data, begun / "data")
        self.sweep(Writer(["dataset", "card", self.root / "data"], begun=begun, runs=3, partial=("SHA256SUMS",)))

    def test_merge(self):
        self.sweep(Writer(["dataset", "merge", self.root / "merged", self.data()], again=(), runs=3, partial=("SHA256SUMS",)))

    def test_train(self):
        data = self.folder / "data"
        self.make("datagen", "open", "--doors", self.door, "--episodes", 2, "--seed", 3, "--set", "preview=false", "--out", data)
        self.sweep(Writer(["train", "open", "--data", data, "--out", self.root / "policy", "--set", "batch_size=8", "--seed", 1,
                           "--epochs", 1], again=("--resume",), runs=1, volatile=("losses.jsonl", "training.html"), partial=("*",)))

    def test_repair(self):
        box = self.door / "meshes/visual"
        mesh = sorted(box.rglob("*.obj"))[0]
        self.sweep(Writer(["repair", mesh, self.root / "mesh.obj"], runs=3))

    def test_pages(self):
        self.sweep(Writer(["view", self.door, "--out", self.root / "page.html"], runs=3))

    def test_preview(self):
        self.sweep(Writer(["preview", self.door, "--out", self.root / "picture.png"], runs=2))

    def test_pipeline(self):
        declared = self.folder / "two.yaml"
        declared.write_text(PIPELINE)
        self.use_small_catalogue()
        self.sweep(Writer(["pipeline", declared, "--out", self.root / "run"], again=(), runs=2, partial=("*",), codes=(3, 4)))


class LongFaults(Faults):
    """Whose every run takes long; they are part of the whole."""
    def test_simulate_film(self):
        self.sweep(Writer(["simulate", "--door", self.door, "--seeds", 1, "--film", self.root / "film"], runs=4))

    def test_lerobot(self):
        self.sweep(Writer(["dataset", "export", self.data(), "--to", "lerobot", "--python", "/usr/bin/python3", "--out", self.root / "lerobot"], runs=3))


# each of the others once, and these where all is asked for
for inherited in [name for name in dir(Faults) if name.startswith("test_")] + ([] if ALL else ["test_simulate_film", "test_lerobot"]):
    setattr(LongFaults, inherited, None)

if __name__ == "__main__":
    unittest.main(verbosity=2)

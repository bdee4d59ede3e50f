# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Data sets and trainings that are damaged, hostile, or written by two at once."""
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from programs import BINARY_DIR, ProgramTest, run

PATIENCE = 300  # beside a build or other tests everything takes longer


def hidden(folder: pathlib.Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob(".*"))


def contents(folder: pathlib.Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


class DamagedData(ProgramTest):
    @classmethod
    def setUpClass(cls) -> None:
        """A door and a sound data set of it, of which each test damages a copy."""
        scratch = tempfile.TemporaryDirectory(dir=BINARY_DIR)
        cls.addClassCleanup(scratch.cleanup)
        cls.door, cls.sound = pathlib.Path(scratch.name) / "door", pathlib.Path(scratch.name) / "data"
        for made in (run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_02", "--out", cls.door),
                     run(*cls.collection(cls.sound))):
            assert made.returncode == 0, made

    def setUp(self) -> None:
        super().setUp()
        self.data = self.folder / "data"
        shutil.copytree(self.sound, self.data)

    @classmethod
    def collection(cls, out: pathlib.Path, *more: object, episodes: int = 3) -> list:
        return ["datagen", "open", "--doors", cls.door, "--out", out, "--episodes", episodes, "--seed", 3, "--set",
                "preview=false", "--set", "collection.episodes_per_shard=1", *more]

    def collect(self, out: pathlib.Path, *more: object) -> subprocess.CompletedProcess:
        return run(*self.collection(out, *more))

    def training(self, out: pathlib.Path, *more: object) -> list:
        return ["train", "open", "--data", self.data, "--out", out, "--threads", 1, *more]

    def start(self, *arguments: object) -> subprocess.Popen:
        """`doorforge ARGUMENTS` in the background, no longer than the test."""
        process = subprocess.Popen([str(BINARY_DIR / "bin/doorforge"), *map(str, arguments)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True)
        self.addCleanup(self.kill, process)
        return process

    def wait_until(self, holds, what: str, process: subprocess.Popen) -> None:
        end = time.monotonic() + PATIENCE
        while not holds():
            if process.poll() is not None:
                self.fail(f"ended before {what}: {process.communicate()}")
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.01)

    def kill(self, process: subprocess.Popen, how: int = signal.SIGKILL) -> str:
        if process.poll() is None:
            os.killpg(process.pid, how)
        return process.communicate(timeout=PATIENCE)[1] if process.stderr and not process.stderr.closed else ""

    def assert_verified(self, data: pathlib.Path) -> None:
        result = run("dataset", "verify", data)
        self.assert_ends(result, 0)
        self.assertIn("no faults", result.stdout)

    # ---- verify ---------------------------------------------------------------------------------

    def test_verify_finds_a_change_in_any_file(self):
        self.assert_ends(run("dataset", "card", self.data), 0)
        self.assert_verified(self.data)
        files = sorted(path for path in self.data.rglob("*") if path.is_file())
        self.assertLessEqual({"README.md", "SHA256SUMS", "config.yaml", "croissant.json", "dataset.json",
                              "failures.jsonl", "provenance.json", "train.txt", "val.txt",
                              "shard-000000.tar"}, {path.name for path in files})
        for path in files:
            sound = path.read_bytes()
            flipped = bytearray(sound or b"x")
            flipped[len(flipped) // 2] ^= 4
            for damage, content in (("a bit", bytes(flipped)), ("nonsense", b"nonsense\n")):
                with self.subTest(str(path.relative_to(self.data)), damage=damage):
                    path.write_bytes(content)
                    result = run("dataset", "verify", self.data)
                    self.assert_ends(result, 1)
                    self.assertIn(str(path), result.stdout)
            path.write_bytes(sound)
        self.assert_verified(self.data)

    def test_every_way_to_a_data_set_ends_in_one_that_verifies(self):
        for task in range(3):
            self.assert_ends(self.collect(self.folder / "tasks", "--task", f"{task}/3"), 0)
        self.assert_ends(run("dataset", "merge", self.folder / "tasks"), 0)
        for task in range(2):
            self.assert_ends(self.collect(self.folder / f"part{task}", "--task", f"{task}/2"), 0)
        self.assert_ends(run("dataset", "merge", self.folder / "merged", self.folder / "part0", self.folder / "part1"), 0)
        self.assert_ends(run("dataset", "re-observe", self.data, "--doors", self.door, "--out", self.folder / "again"), 0)
        for name in ("data", "tasks", "merged", "again"):
            self.assert_verified(self.folder / name)
            self.assertEqual(hidden(self.folder / name), [])
        self.assertEqual(contents(self.folder / "tasks"), contents(self.data))
        self.assertEqual(contents(self.folder / "merged"), contents(self.data))
        sums = subprocess.run(["sha256sum", "--quiet", "-c", "SHA256SUMS"], cwd=self.data, capture_output=True, text=True)
        self.assertEqual((sums.returncode, sums.stdout + sums.stderr), (0, ""))

    def test_a_file_of_the_user_is_named_and_no_fault(self):
        (self.data / "NOTES.md").write_text("mine")
        result = run("dataset", "verify", self.data)
        self.assert_ends(result, 0)
        self.assertIn("NOTES.md: no part of the dataset; it was not checked", result.stdout)
        (self.data / "README.md").write_text("my own words\n")
        self.assert_ends(run("dataset", "verify", self.data), 1)
        self.assert_refused(run("dataset", "card", self.data), 2)
        self.assertEqual((self.data / "README.md").read_text(), "my own words\n")
        self.assert_ends(run("dataset", "card", self.data, "--keep-readme"), 0)
        self.assertEqual((self.data / "README.md").read_text(), "my own words\n")
        self.assert_ends(run("dataset", "verify", self.data), 0)

    # ---- two writers ----------------------------------------------------------------------------

    def test_a_second_training_into_one_folder_is_refused(self):
        out = self.folder / "policy"
        first = self.start(*self.training(out, "--epochs", 100000, "--seed", 1))
        self.wait_until(lambda: (out / ".writing").exists() and (out / ".writing").read_text().endswith("\n"),
                        "the first wrote who it is", first)
        for more in ([], ["--overwrite"], ["--resume"]):
            second = run(*self.training(out, "--epochs", 1, "--seed", 2, *more))
            self.assert_refused(second, 2)
            self.assertIn(f"{out}: doorforge train (process {first.pid} on ", second.stderr)
            self.assertIn("writes there at this moment", second.stderr)
        self.wait_until(lambda: (out / "losses.jsonl").exists(), "the first epoch", first)
        self.kill(first, signal.SIGINT)
        self.assertEqual(first.returncode, 130)
        self.assertIn('"seed": 1', (out / "config.yaml").read_text())
        self.assertEqual(hidden(out), [])
        self.assert_ends(run(*self.training(out, "--epochs", 1, "--seed", 2, "--overwrite")), 0)

    def test_a_data_set_is_not_replaced_while_it_is_written(self):
        out = self.folder / "busy"
        busy = self.start(*self.collection(out, "-j", 1, episodes=100000))
        self.wait_until(lambda: list(out.glob("open/train/shard-*.index.json")), "a shard", busy)
        for arguments in (self.collection(out, "--overwrite"), ["dataset", "merge", out], ["dataset", "card", out]):
            refused = run(*arguments)
            self.assert_refused(refused, 2)
            self.assertIn(f"{out}: doorforge datagen (process {busy.pid} on ", refused.stderr)
        self.kill(busy, signal.SIGINT)
        self.assertEqual(busy.returncode, 130)
        self.assertTrue(list(out.glob("open/train/shard-*.tar")))
        self.assertFalse((out / ".writing").exists())

    def test_a_folder_that_is_no_data_set_is_not_replaced(self):
        mine = self.folder / "mine"
        mine.mkdir()
        (mine / "config.yaml").write_text("mine: true\n")
        (mine / "thesis.txt").write_text("years of work")
        before = contents(mine)
        self.assert_refused(self.collect(mine, "--overwrite"), 2)
        self.assertEqual(contents(mine), before)
        self.assert_refused(run("quickstart", "--out", mine, "--overwrite"), 2)
        self.assertEqual(contents(mine), before)

    # ---- damage while it is read ----------------------------------------------------------------

    def test_a_shard_that_is_cut_under_a_training_ends_it_with_a_message(self):
        out = self.folder / "policy"
        training = self.start(*self.training(out, "--epochs", 100000))
        self.wait_until(lambda: (out / "losses.jsonl").exists(), "the first epoch", training)
        tar = next(path for path in sorted(self.data.glob("open/train/*.tar")))
        os.truncate(tar, 4096)
        message = training.communicate(timeout=PATIENCE)[1]
        self.assertEqual(training.returncode, 3, message[-2000:])
        self.assertIn(f"{tar}: was cut by another program", message)
        self.assertFalse((out / "policy.json").exists())
        self.assertEqual(hidden(out), [])

    # ---- killed ---------------------------------------------------------------------------------

    def test_nothing_of_a_killed_writer_is_left_after_the_next_run(self):
        whole = contents(self.data)
        for delay in (0.3, 0.5, 0.7, 0.9):
            out = self.folder / "killed"
            process = self.start(*self.collection(out))
            time.sleep(delay)
            self.kill(process)
        self.assert_ends(self.collect(out), 0)
        self.assertEqual(hidden(out), [])
        self.assertEqual(contents(out), whole)

    def end_within_a_file(self, blocks: int, *arguments: object) -> None:
        """Runs `doorforge ARGUMENTS` until it has written so many KiB of one file, and ends it there."""
        command = shlex.join([str(BINARY_DIR / "bin/doorforge"), *map(str, arguments)])
        result = subprocess.run(["bash", "-c", f"ulimit -c 0 -f {blocks}; exec {command}"], capture_output=True,
                                timeout=300)
        self.assertEqual(result.returncode, -signal.SIGXFSZ, result.stderr[-2000:])

    def test_nothing_of_a_writer_that_ended_within_a_file_is_left_after_the_next_run(self):
        out, policy = self.folder / "ended", self.folder / "policy"
        self.end_within_a_file(1, *self.collection(out))
        self.assertTrue(any(".tmp-" in name for name in hidden(out)), hidden(out))
        self.assert_ends(self.collect(out), 0)
        self.assertEqual(hidden(out), [])
        self.assertEqual(contents(out), contents(self.data))

        self.end_within_a_file(100, *self.training(policy, "--epochs", 2))
        self.assertTrue(any(".tmp-" in name for name in hidden(policy)), hidden(policy))
        self.assert_ends(run(*self.training(policy, "--epochs", 1, "--overwrite")), 0)
        self.assertEqual(hidden(policy), [])

        exported = self.folder / "exported"
        exported.mkdir()
        export = ["dataset", "export", self.data, "--to", "robomimic", "--out", exported / "data.hdf5"]
        self.end_within_a_file(64, *export)
        self.assertNotEqual(hidden(exported), [])
        self.assert_ends(run(*export), 0)
        self.assertEqual([path.name for path in exported.iterdir()], ["data.hdf5"])

    # ---- nothing is replaced unasked ------------------------------------------------------------

    def test_nothing_is_replaced_unasked(self):
        mine = self.folder / "mine.yaml"
        film = self.folder / "films/interior_flush_01__interior_lever_tube_02_seed1_0.png"
        film.parent.mkdir()
        for path, arguments in (
            (mine, self.collection(self.folder / "later", "--slurm", mine, "--tasks", 2)),
            (self.folder / "door.png", ["preview", self.door, "--out", self.folder / "door.png"]),
            (self.folder / "data.png", ["dataset", "info", self.data, "--png", self.folder / "data.png"]),
            (self.folder / "data.html", ["dataset", "info", self.data, "--html", self.folder / "data.html"]),
            (film, ["simulate", "--door", self.door, "--seeds", 1, "--set", "scene.physics.max_opening_actions=4", "--film", film.parent]),
            (self.folder / "data.hdf5", ["dataset", "export", self.data, "--to", "robomimic", "--out",
                                         self.folder / "data.hdf5"]),
        ):
            with self.subTest(path.name):
                path.write_text("mine")
                refused = run(*arguments)
                self.assert_refused(refused, 2)
                self.assertIn(str(path), refused.stderr)
                self.assertIn("--overwrite", refused.stderr)
                self.assertEqual(path.read_text(), "mine")
                self.assert_ends(run(*arguments, "--overwrite"), 0, 1)
                self.assertNotEqual(path.read_bytes(), b"mine")

    def test_the_same_slurm_script_is_written_twice(self):
        script = self.folder / "collect.sh"
        for _ in range(2):
            self.assert_ends(self.collect(self.folder / "later", "--slurm", script, "--tasks", 2), 0)

    # ---- hostile records ------------------------------------------------------------------------

    def test_a_robot_that_a_data_set_names_is_not_opened_for_that(self):
        config = self.data / "config.yaml"
        secret = self.folder / "secret.urdf"
        secret.write_text("<robot name='secret'/>")
        config.write_text(config.read_text().replace('"robot": ""', f'"robot": "{secret}"'))
        self.assertIn(str(secret), config.read_text())
        refused = run("dataset", "re-observe", self.data, "--doors", self.door, "--out", self.folder / "again")
        self.assert_refused(refused, 2)
        self.assertIn("pass --robot", refused.stderr)
        self.assertFalse((self.folder / "again").exists())

    def test_an_export_of_no_decisions_is_refused(self):
        record = json.loads((self.data / "dataset.json").read_text())
        for part in record["parts"]:
            part["decisions"] = 0
        (self.data / "dataset.json").write_text(json.dumps(record))
        refused = run("dataset", "export", self.data, "--to", "robomimic", "--out", self.folder / "data.hdf5")
        self.assert_refused(refused, 2)
        self.assertIn("0 decisions", refused.stderr)

    def test_no_path_of_a_record_leaves_the_data_set(self):
        hostile = self.folder / "hostile"
        shutil.copytree(self.data, hostile)
        (hostile / "SHA256SUMS").unlink(missing_ok=True)
        for key in ("stage", "split"):
            record = json.loads((self.data / "provenance.json").read_text())
            for part in record["planned"]:
                part[key] = "../../escaped"
            (hostile / "provenance.json").write_text(json.dumps(record))
            with self.subTest(key):
                merged = run("dataset", "merge", self.folder / "a/b/merged", hostile)
                self.assert_refused(merged, 3)
                self.assertIn("provenance.json", merged.stderr)
                self.assertNotIn("escaped", " ".join(str(path) for path in self.folder.rglob("*")))


if __name__ == "__main__":
    unittest.main(verbosity=2)

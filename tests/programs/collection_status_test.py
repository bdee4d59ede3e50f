# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""`dataset status` beside tasks that run: it sees them come on, ends with its code, and changes no byte of theirs."""
import hashlib
import json
import pathlib
import subprocess
import unittest

from programs import BINARY_DIR, ProgramTest, run


def hashes(folder: pathlib.Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class CollectionStatus(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.door, self.data = self.folder / "door", self.folder / "data"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out",
                             self.door), 0)

    def collect(self, out: pathlib.Path, *more: object) -> list[str]:
        return [str(word) for word in (
            BINARY_DIR / "bin/doorforge", "datagen", "open", "--doors", self.door, "--out", out, "--episodes", 6, "--seed", 3,
            "-j", 1, "--set", "preview=false", "--set", "cloud.point_count=64", "--set", "collection.episodes_per_shard=1",
            *more)]

    def status(self, *more: object, code: int) -> dict:
        result = run("dataset", "status", self.data, "--json", *more)
        self.assert_ends(result, code)
        return json.loads(result.stdout)

    def test_two_tasks_are_watched_and_write_what_they_would_alone(self):
        subprocess.run(self.collect(self.folder / "alone"), check=True, capture_output=True)
        tasks = [subprocess.Popen(self.collect(self.data, "--task", f"{i}/2"), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) for i in range(2)]
        while not (self.data / "provenance.json").exists():
            self.assertIsNone(tasks[0].poll(), "the first task ended before it wrote anything")
        watched = run("dataset", "status", self.data, "--watch", "--every", 0.1, "--json", "--tasks", 2, timeout=600)
        self.assertEqual([task.wait() for task in tasks], [0, 0])
        self.assert_ends(watched, 4)  # all shards are there, and nobody has merged them
        looks = [json.loads(line) for line in watched.stdout.splitlines()]
        run_episodes = [look["episodes"]["run"] for look in looks]
        self.assertEqual(run_episodes, sorted(run_episodes))
        self.assertGreater(len(set(run_episodes)), 2, "nothing was seen to come on")
        for look in looks:
            shards = look["shards"]
            self.assertEqual(shards["planned"], shards["done"] + shards["being_written"] + shards["begun"] + shards["open"])
        last = looks[-1]
        self.assertEqual((last["shards"]["done"], last["episodes"]["run"], last["complete"]), (6, 6, False))
        self.assertEqual([task["done_shards"] for task in last["tasks"]], [3, 3])
        self.assertIn("dataset merge", last["next"])

        self.assert_ends(run("dataset", "merge", self.data), 0)
        complete = self.status(code=0)
        self.assertTrue(complete["complete"])
        self.assertEqual(hashes(self.data), hashes(self.folder / "alone"))
        info = json.loads(run("dataset", "info", self.data, "--json").stdout)
        self.assertEqual(complete["episodes"]["kept"], sum(part["episodes"] for part in info["parts"]))
        self.assertEqual(complete["failures"], info["failures"])

    def test_what_is_left_is_named_with_its_task(self):
        subprocess.run(self.collect(self.data, "--task", "1/3"), check=True, capture_output=True)
        status = self.status("--tasks", 3, code=4)
        self.assertEqual(status["shards"], {"planned": 6, "done": 2, "being_written": 0, "begun": 0, "open": 4})
        self.assertEqual([task["run"] for task in status["tasks"]], [0, 2, 0])
        self.assertIn("task 0/3", status["next"])
        self.assertIsNone(status["seconds_left"])

    def test_a_folder_without_a_collection(self):
        self.assert_refused(run("dataset", "status", self.folder / "nothing"), 3)


if __name__ == "__main__":
    unittest.main(verbosity=2)

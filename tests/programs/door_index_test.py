# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The index that `compose` leaves beside many doors: no byte of what is made from the doors depends on it."""
import json
import pathlib
import shutil
import unittest

from programs import ProgramTest, run

INDEX = "door_index.json"


def contents(folder: pathlib.Path) -> dict:
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


class DoorIndex(ProgramTest):
    def compose(self, name: str, *arguments: object) -> pathlib.Path:
        doors = self.folder / name
        self.assert_ends(run("compose", "--body", "safe_box_small_0[12]", "--handle", "safe_[de]*_01", "--out", doors, *arguments), 0)
        return doors

    def collect(self, doors: pathlib.Path, name: str, *arguments: object) -> pathlib.Path:
        data = self.folder / name
        self.assert_ends(run("datagen", "open", "--doors", doors, "--out", data, "--episodes", 12, "--seed", 5,
                             "--set", "cloud.point_count=64", "--set", "preview=false",
                             "--set", "collection.episodes_per_shard=4", *arguments), 0, 1)
        return data

    def evaluate(self, doors: pathlib.Path) -> dict:
        result = run("eval", "--opener", "expert", "--doors", doors, "-n", 2, "--seeds", 1, "--json")
        self.assert_ends(result, 0)
        report = json.loads(result.stdout)
        del report["provenance"]["command"]
        return report

    def test_doors_and_index_have_the_same_bytes_however_they_are_composed(self):
        one = contents(self.compose("one", "--threads", 1))
        self.assertEqual(contents(self.compose("two", "--threads", 2)), one)
        self.assertIn(INDEX, one)
        # given again the command keeps the doors, and brings back an index that was lost
        (self.folder / "one" / INDEX).unlink()
        self.assertEqual(contents(self.compose("one")), one)
        self.assertEqual(len(json.loads(one[INDEX])["doors"]), sum(name.endswith("door.json") for name in one))

    def test_data_sets_plans_and_reports_are_the_same_without_it(self):
        doors = self.compose("doors")
        bare = self.folder / "bare"
        shutil.copytree(doors, bare, ignore=shutil.ignore_patterns(INDEX))
        whole = contents(self.collect(doors, "data"))
        self.assertTrue(any(name.endswith(".tar") for name in whole))
        self.assertEqual(contents(self.collect(bare, "bare_data")), whole)
        self.assertFalse((bare / INDEX).exists(), "who reads doors writes nothing beside them")
        for task in range(2):
            self.collect(doors if task else bare, f"task{task}", "--task", f"{task}/2")
        merged = self.folder / "merged"
        self.assert_ends(run("dataset", "merge", merged, self.folder / "task0", self.folder / "task1"), 0)
        self.assertEqual({name: data for name, data in contents(merged).items() if ".tar" in name},
                         {name: data for name, data in whole.items() if ".tar" in name})
        plans = [run("datagen", "plan", "open", "--doors", folder, "--episodes", 50, "--probe", 0, "--json")
                 for folder in (doors, bare)]
        self.assert_ends(plans[0], 0)
        self.assertEqual(plans[0].stdout, plans[1].stdout)
        self.assertEqual(self.evaluate(doors), self.evaluate(bare))
        rows = [run("simulate", "--door", folder, "--json").stdout for folder in (doors, bare)]
        self.assertEqual(rows[0], rows[1])

    def test_a_changed_door_is_used_as_it_is_and_a_forged_index_refused(self):
        doors = self.compose("doors")
        record = next(doors.glob("*/door.json"))
        record.write_text(record.read_text().replace('"damping_nm_s":', '"damping_nm_s": ', 1))
        before = contents(self.collect(doors, "before"))
        (doors / INDEX).rename(self.folder / "kept.json")
        self.assertEqual(contents(self.collect(doors, "after")), before)
        index = json.loads((self.folder / "kept.json").read_text())
        for door in index["doors"]:
            door["sha256"] = "0" * 64
        (doors / INDEX).write_text(json.dumps(index))
        record.unlink()
        for command in (["eval", "--opener", "expert", "--doors", doors, "--seeds", 1],
                        ["simulate", "--door", doors],
                        ["datagen", "open", "--doors", doors, "--out", self.folder / "forged", "--episodes", 2]):
            self.assert_refused(run(*command), 3)
        (doors / INDEX).write_text("[" * 100_000)
        result = run("simulate", "--door", doors)
        self.assert_refused(result, 3)
        self.assertIn(INDEX, result.stderr)
        result = run("validate", doors)  # which asks no index what a door is, and misses the record that is gone
        self.assert_ends(result, 3)
        self.assertIn(record.parent.name, result.stderr)
        self.assertNotIn(INDEX, result.stderr)


if __name__ == "__main__":
    unittest.main()

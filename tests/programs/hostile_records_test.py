# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Records, settings and names that somebody wrote to do harm, or that were damaged, through every verb that reads them."""
import json
import os
import pathlib
import shutil
import subprocess
import unittest

from programs import BINARY_DIR, ProgramTest, run

CYCLE = "a: &a [*a]\n"
BILLIONS = "a0: &a0 [1,1,1,1,1,1,1,1,1]\n" + "".join(
    f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 10))


def edit(path: pathlib.Path, **values) -> None:
    record = json.loads(path.read_text())
    record.update(values)
    path.write_text(json.dumps(record))


class HostileRecords(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.victim = self.folder / "precious"
        self.victim.mkdir()
        (self.victim / "work.txt").write_text("years of it")

    def make_door(self) -> pathlib.Path:
        door = self.folder / "doors/mine"
        result = run("compose", "--body", "safe_antique_01", "--handle", "safe_ell_01", "--out", door)
        self.assert_ends(result, 0)
        return door

    def assert_victim_untouched(self) -> None:
        self.assertEqual({path.name: path.read_text() for path in self.victim.iterdir()},
                         {"work.txt": "years of it"})

    def assert_nothing_outside(self, *expected: str) -> None:
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted(["precious", *expected]))

    def test_a_doors_id_deletes_and_writes_nothing_outside_of_out(self):
        door = self.make_door()
        for name in (str(self.victim), "../precious", "../escaped", "", ".", "..", "a/b", "-rf", "a\nb"):
            with self.subTest(id=name):
                edit(door / "door.json", id=name)
                out = self.folder / "out"
                out.mkdir()
                (out / "mine.txt").write_text("mine")
                self.assert_refused(run("export", door, "--to", "urdf", "--out", out, "--overwrite"), 1, 3)
                self.assertEqual([path.name for path in out.iterdir()], ["mine.txt"])
                shutil.rmtree(out)
                validated = run("validate", door)
                self.assert_ends(validated, 1)
                self.assertIn("REC004", validated.stdout)
                film = run("simulate", "--door", door, "--episodes", 1, "--film", self.folder / "out")
                self.assert_refused(film, 1, 3)
                self.assertFalse((self.folder / "out").exists() and any((self.folder / "out").iterdir()))
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                self.assert_victim_untouched()
                self.assert_nothing_outside("doors")

    def test_the_name_of_a_piece_writes_nothing_outside_of_out(self):
        door = self.make_door()
        record = json.loads((door / "door.json").read_text())
        for link in record["links"]:
            for geometry in link["geometry"]:
                geometry["name"] = "../../../../precious/" + geometry["name"]
        (door / "door.json").write_text(json.dumps(record))
        self.assert_refused(run("export", door, "--to", "urdf", "--out", self.folder / "out"), 1, 3)
        self.assert_victim_untouched()

    def test_a_parts_id_writes_nothing_outside_of_out(self):
        parts = self.folder / "parts"
        self.assert_ends(run("catalog", "build", "--category", "safe", "--out", parts), 0)
        for folder in parts.iterdir():
            if folder.name not in ("safe_antique_01", "safe_ell_01"):
                shutil.rmtree(folder)
        edit(parts / "safe_antique_01/part.json", id="../../../escaped")
        for more in ([], ["--standalone"]):
            result = run("compose", "--all", "--parts", parts, "--out", self.folder / "a/b/out", *more)
            self.assert_refused(result, 1, 2, 3)
            self.assertIn("part.json", result.stderr)
            shutil.rmtree(self.folder / "a", ignore_errors=True)
            self.assert_nothing_outside("parts")
        validated = run("validate", parts)
        self.assert_ends(validated, 1)
        self.assertIn("REC004", validated.stdout)

    def test_overwrite_replaces_only_what_doorforge_wrote(self):
        door = self.make_door()
        for command in (["compose", "--body", "safe_antique_01", "--handle", "safe_ell_01"],
                        ["quickstart"],
                        ["datagen", "open", "--doors", door, "--episodes", 1]):
            with self.subTest(command[0]):
                (self.victim / "config.yaml").write_text("mine: 1\n")
                result = run(*command, "--out", self.victim, "--overwrite")
                self.assert_refused(result, 2)
                self.assertIn(str(self.victim), result.stderr)
                (self.victim / "config.yaml").unlink()
                self.assert_victim_untouched()
        out = self.folder / "out"
        (out / "safe_antique_01__safe_ell_01").mkdir(parents=True)
        (out / "safe_antique_01__safe_ell_01/work.txt").write_text("years of it")
        result = run("export", door, "--to", "urdf", "--out", out, "--overwrite")
        self.assert_refused(result, 1)
        self.assertEqual((out / "safe_antique_01__safe_ell_01/work.txt").read_text(), "years of it")
        shutil.rmtree(out)
        for _ in range(2):
            self.assert_ends(run("export", door, "--to", "urdf", "--out", out, "--overwrite"), 0)

    def test_settings_that_name_themselves_are_refused(self):
        door = self.make_door()
        for text in (CYCLE, BILLIONS, "[" * 100_000):
            settings = self.folder / "x.yaml"
            settings.write_text(text)
            for command in (["simulate", "--door", door], ["datagen", "open", "--doors", door, "--out", self.folder / "d"],
                            ["eval", "--opener", "expert", "--doors", door], ["compose", "--out", self.folder / "d"],
                            ["train", "open", "--data", self.folder, "--out", self.folder / "d"],
                            ["repair", self.folder / "a.obj", self.folder / "b.obj"],
                            ["import", self.folder, "--out", self.folder / "d"]):
                with self.subTest(verb=command[0], begin=text[:20]):
                    result = run(*command, "--config", settings, timeout=60, memory_gib=4)
                    self.assert_refused(result, 2, 3)
                    self.assertIn("x.yaml", result.stderr)
            with self.subTest(verb="pipeline", begin=text[:20]):
                self.assert_refused(run("pipeline", settings, "--out", self.folder / "d", timeout=60, memory_gib=4), 2, 3)

    def test_deep_json_is_refused_by_name(self):
        door = self.make_door()
        for name, command in ((door / "door.json", ["export", door, "--to", "urdf", "--out", self.folder / "out"]),
                              (door / "door.json", ["validate", door])):
            record = name.read_text()
            name.write_text('{"schema": ' + "[" * 300_000 + "]" * 300_000 + "}")
            result = run(*command)
            self.assert_ends(result, 1, 3)
            self.assertIn("64 levels", result.stdout + result.stderr)
            name.write_text(record)

    def test_names_that_are_no_utf8_are_reported_as_json(self):
        doors = self.folder / "doors"
        self.make_door()
        bad = os.fsdecode(os.fsencode(doors) + b"/b\xffd")
        shutil.copytree(doors / "mine", bad)
        for command in (["validate", "--json", doors],
                        ["export", "--json", doors, "--to", "urdf", "--out", self.folder / "out", "--overwrite"]):
            result = subprocess.run([str(BINARY_DIR / "bin/doorforge"), *map(str, command)], capture_output=True,
                                    timeout=120)
            self.assertIn(result.returncode, (0, 1), result.stderr)
            json.loads(result.stdout.decode("utf-8"))

    def test_messages_name_the_file_and_no_library(self):
        door = self.make_door()
        settings = self.folder / "mine.yaml"
        for text in ("episodes: many\n", "witch: 1\n", "scene: {camera: 1}\n", "a: b: c\n"):
            settings.write_text(text)
            result = run("datagen", "open", "--doors", door, "--out", self.folder / "d", "--config", settings)
            self.assert_refused(result, 2)
            self.assertIn("mine.yaml", result.stderr)
            self.assertNotIn("yaml-cpp", result.stderr)
        for text in ("body: nothing_01\nhandle: safe_ell_01\n", "body: safe_antique_01\nhandle: nothing_01\n"):
            settings.write_text(text)
            result = run("compose", "--config", settings, "--out", self.folder / "d")
            self.assert_refused(result, 3)
            self.assertIn("mine.yaml", result.stderr)
        settings.write_text("scene: {randomisation: wild}\n")
        for command in (["datagen", "open", "--doors", door, "--episodes", 1, "--out", self.folder / "d"],
                        ["simulate", "--door", door, "--episodes", 1]):
            result = run(*command, "--config", settings)
            self.assert_refused(result, 2)
            self.assertIn("mine.yaml", result.stderr)
        result = run("datagen", "open", "--doors", door, "--out", self.folder / "d", "--set", "scene=1", "--set",
                     "scene.seed=2")
        self.assert_refused(result, 2)
        self.assertNotIn("exception", result.stderr)

    def test_what_a_killed_writer_left_is_removed_at_the_next_start(self):
        parts = ["--body", "safe_antique_01", "--handle", "safe_ell_01"]
        # stopped while it waits for the disk to take its first file: strace is not everywhere, so by time
        for attempt in range(40):
            out = self.folder / "killed"
            process = subprocess.Popen([str(BINARY_DIR / "bin/doorforge"), "compose", *parts, "--out", str(out)],
                                       stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            try:
                process.wait(timeout=0.02 + 0.01 * attempt)
            except subprocess.TimeoutExpired:
                subprocess.run(["pkill", "-KILL", "-P", str(process.pid)], check=False)
                process.kill()
                process.wait()
            shutil.rmtree(out, ignore_errors=True)
            if any(".tmp-" in path.name for path in self.folder.iterdir()):
                break
        else:
            self.fail("no kill came in the middle")
        self.assert_ends(run("compose", *parts, "--out", self.folder / "killed"), 0)
        self.assertEqual([path.name for path in self.folder.iterdir() if ".tmp-" in path.name], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)

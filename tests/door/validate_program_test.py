# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""`doorforge validate` as a user runs it: reports, --fix, profiles, and how it ends when told to."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "programs"))
from programs import BINARY_DIR, ProgramTest  # noqa: E402

PROGRAM = BINARY_DIR / "bin/doorforge-assets"


def run(*arguments: object) -> subprocess.CompletedProcess:
    command = [str(PROGRAM), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


def wait_until_busy(process: subprocess.Popen) -> None:
    """Until the program has worked for 0.3 s: its handlers are in place, on a loaded machine, too."""
    deadline = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < deadline:
        ticks = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()[11]
        if int(ticks) / os.sysconf("SC_CLK_TCK") > 0.3:
            return
        time.sleep(0.02)


class Validate(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.door = self.folder / "doors/mine"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01",
                             "--out", self.door), 0)

    def record(self) -> dict:
        return json.loads((self.door / "door.json").read_text())

    def spoil(self) -> None:
        record = self.record()
        record["hinge"]["axis"] = [0, 0, -2]
        (self.door / "door.json").write_text(json.dumps(record, indent=2) + "\n")

    def test_a_composed_door_passes_every_profile(self):
        for profile in ("urdf", "physics", "openable"):
            result = run("validate", self.door, "--profile", profile, "--json")
            if profile == "openable" and "lacks the simulation" in result.stderr:
                self.assert_refused(result, 2)
                continue
            self.assert_ends(result, 0)
            report = json.loads(result.stdout)
            self.assertEqual(report["findings"], [], profile)
            self.assertTrue(report["complete"])

    def test_fix_mends_and_says_so(self):
        self.spoil()
        before = (self.door / "door.json").read_bytes()
        dry = run("validate", self.door, "--fix", "--dry-run")
        self.assert_ends(dry, 1)
        self.assertIn("would fix MEC001", dry.stdout)
        self.assertEqual((self.door / "door.json").read_bytes(), before)
        fixed = run("validate", self.door, "--fix", "--json")
        self.assert_ends(fixed, 0)
        report = json.loads(fixed.stdout)
        self.assertEqual([fix["code"] for fix in report["fixes"]], ["MEC001"])
        self.assertTrue(report["fixes"][0]["written"])
        self.assertEqual(self.record()["hinge"]["axis"], [0, 0, -1])

    def test_what_cannot_be_fixed_is_left_and_says_why(self):
        (self.door / "meshes/visual/leaf.obj").unlink()
        result = run("validate", self.door, "--fix", "--json")
        self.assert_ends(result, 1)
        report = json.loads(result.stdout)
        self.assertEqual([(finding["code"], finding["fixable"]) for finding in report["findings"]],
                         [("MSH001", False)])
        self.assertEqual(report["fixes"], [])
        self.assert_refused(run("validate", self.door, "--dry-run"), 2)

    def test_it_says_when_it_checked_nothing(self):
        empty = self.folder / "empty"
        empty.mkdir()
        (self.folder / "gate.xyz").write_text("<robot/>")
        for path in (empty, self.folder / "none"):
            result = run("validate", path)
            self.assert_refused(result, 3)
            self.assertIn("nothing checked", result.stdout)
            self.assertNotIn("0 errors", result.stdout)
            self.assertIn("doorforge compose", result.stderr)
        self.assertIn("no such file", run("validate", self.folder / "none.urdf").stderr)
        self.assertIn("FIL011", run("validate", self.folder / "gate.xyz").stdout)
        self.assertIn("no such folder", run("validate", self.folder / "none").stderr)
        report = run("validate", empty, "--json")
        self.assert_refused(report, 3)
        self.assertEqual(json.loads(report.stdout)["counts"]["folders"], 0)

    def test_one_is_one(self):
        self.assertIn("1 folder: 0 errors, 0 warnings", run("validate", self.door).stdout)
        self.spoil()
        self.assertIn("1 folder: 1 error, 0 warnings", run("validate", self.door).stdout)

    def test_a_door_without_its_record_does_not_vanish(self):
        (self.door / "door.json").unlink()
        for path in (self.door, self.door.parent):
            result = run("validate", path)
            self.assert_refused(result, 3)
            self.assertIn("nothing checked: 1 record missing", result.stdout)
            self.assertIn(f"{self.door}: door.json is missing", result.stderr)

    def compose_four(self) -> pathlib.Path:
        many = self.folder / "many"
        self.assert_ends(run("compose", "--body", "interior_flush_0[12]", "--handle", "interior_lever_tube_0[12]",
                             "--out", many), 0)
        self.assertIn("4 folders: 0 errors", run("validate", many).stdout)
        return many

    def test_many_doors_are_counted_against_their_index(self):
        many = self.compose_four()
        doors = sorted(path.parent for path in many.glob("*/door.json"))
        (doors[0] / "door.json").unlink()
        (doors[1] / "door.json").unlink()
        (doors[1] / "model.urdf").unlink()
        doors[1].rmdir()
        # a door by another name is there
        doors[2].rename(many / "renamed")
        result = run("validate", many, "--json")
        self.assert_refused(result, 3)
        report = json.loads(result.stdout)
        self.assertEqual(report["counts"]["folders"], 2)
        self.assertEqual([entry["folder"] for entry in report["missing"]], [str(doors[0]), str(doors[1])])
        self.assertIn("2 folders, 2 missing: 0 errors", run("validate", many).stdout)
        # without the index, its other file still tells of the first
        (many / "door_index.json").unlink()
        report = json.loads(run("validate", f"{many}/", "--json").stdout)
        self.assertEqual([entry["folder"] for entry in report["missing"]], [str(doors[0])])
        self.assertEqual(json.loads(run("validate", many / "renamed", "--json").stdout)["missing"], [])

    def test_as_many_as_expected(self):
        many = self.compose_four()
        self.assert_ends(run("validate", many, "--expect", "4"), 0)
        for number in (3, 5):
            result = run("validate", many, "--expect", number)
            self.assert_refused(result, 4)
            self.assertIn(f"4 folders checked, expected {number}", result.stderr)
        self.assert_refused(run("validate", many, "--expect", "0"), 2)

    def test_the_rules_are_json_on_demand(self):
        report = json.loads(run("validate", "--rules", "--json").stdout)
        self.assertEqual(report["schema"], "doorforge.validation_rules")
        listed = [line.split()[0] for line in run("validate", "--rules").stdout.splitlines()]
        self.assertEqual([rule["code"] for rule in report["rules"]], listed)
        rules = {rule["code"]: rule for rule in report["rules"]}
        self.assertEqual(rules["HND009"]["limit"], 0.12)
        self.assertIn("0.12 m", rules["HND009"]["allowed"])
        self.assertIsNone(rules["REC001"]["limit"])
        for rule in report["rules"]:
            self.assertIn(rule["severity"], ("error", "warning", "info"))
            self.assertNotIn("{}", rule["allowed"])
            self.assertTrue(rule["text"] and rule["fix"])
            self.assertIsInstance(rule["fixable"], bool)

    def test_a_stop_request_ends_it_soon_with_what_is_done(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            # the same door many times: minutes of work, if nobody stops it
            command = [str(PROGRAM), "validate", "--json", "--threads", "1", *[str(self.door)] * 20000]
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            wait_until_busy(process)
            asked = time.monotonic()
            process.send_signal(number)
            out, err = process.communicate(timeout=60)
            self.assertLess(time.monotonic() - asked, 20)
            self.assertEqual(process.returncode, 128 + number, err)
            self.assertIn("stopped after", err)
            report = json.loads(out)
            self.assertFalse(report["complete"])
            self.assertLess(report["counts"]["folders"], 20000)


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The benchmark's rows on a few doors: killed in the middle it goes on, and ends as if nobody had; environments by name."""
import json
import pathlib
import signal
import subprocess
import time
import unittest

from programs import BINARY_DIR, ProgramTest, run

# On the sides that the benchmark judges: doors of a category that was trained on, and of one that was not.
PAIRS = (("interior_planked_01", "interior_lever_cranked_03"), ("storage_arched_corner_01", "storage_knob_ball_01"))


def made(folder: pathlib.Path) -> dict[str, list]:
    """The episodes of every report, with the hashes of their last states; a report also names its folder."""
    return {str(path.relative_to(folder)): json.loads(path.read_text())["episodes"]
            for path in sorted((folder / "rows").rglob("report.json"))}


class BenchmarkTest(ProgramTest):
    def compose(self) -> pathlib.Path:
        doors = self.folder / "doors"
        for body, handle in PAIRS:
            self.assert_ends(run("compose", "--body", body, "--handle", handle, "--out", doors / body), 0)
        return doors


class Rows(BenchmarkTest):
    def benchmark(self, out: pathlib.Path, *more: object) -> list:
        return ["benchmark", "quick", "--out", out, "--doors", self.doors, "--rows", "expert", "gapartnet_clean",
                "--set", "seeds=2", *more]

    def setUp(self) -> None:
        super().setUp()
        self.doors = self.compose()

    def test_killed_in_the_middle_it_goes_on_and_ends_alike(self):
        whole = self.folder / "whole"
        result = run(*self.benchmark(whole))
        self.assert_ends(result, 0)
        table = json.loads((whole / "benchmark.json").read_text())
        self.assertEqual([row["name"] for row in table["rows"]], ["expert", "gapartnet_clean"])
        self.assertEqual(table["rows"][0]["success"]["success"]["interior"]["mean"], 1.0)
        self.assertIn("gapartnet_clean", result.stdout)

        killed = self.folder / "killed"
        process = subprocess.Popen([str(BINARY_DIR / "bin/doorforge"), *map(str, self.benchmark(killed))],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        deadline = time.monotonic() + 120
        while not (killed / "rows/expert_1_test/report.json").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertFalse((killed / "benchmark.json").exists())
        result = run(*self.benchmark(killed, "--json"))
        self.assert_ends(result, 0)
        self.assertEqual(json.loads(result.stdout), table, "what the steps print goes elsewhere")
        self.assertEqual(made(killed), made(whole))
        self.assertEqual((killed / "benchmark.json").read_bytes(), (whole / "benchmark.json").read_bytes())
        self.assertEqual((killed / "benchmark.html").read_bytes(), (whole / "benchmark.html").read_bytes())

    def test_the_plan_changes_nothing_and_forecasts(self):
        out = self.folder / "plan"
        result = run("benchmark", "plan", "paper", "--out", out)
        self.assert_ends(result, 0)
        for part in ("without_disentangle_3_unseen", "together", "minutes"):
            self.assertIn(part, result.stdout)
        self.assertFalse(out.exists())

    def test_wrong_use_is_told(self):
        self.assert_refused(run("benchmark", "quick", "--out", self.folder / "x", "--rows", "oars"), 2)
        self.assert_refused(run("benchmark", "quik", "--out", self.folder / "x"), 2)


class Presets(BenchmarkTest):
    def test_each_preset_is_simulated_and_judged_by_its_own_rule(self):
        doors = self.compose()
        for preset, unlatched in (("doorgym", False), ("where2act", True), ("partmanip", True), ("gapartnet", True)):
            with self.subTest(preset):
                result = run("simulate", "--door", doors, "--preset", preset, "--json")
                self.assert_ends(result, 0, 1)
                for episode in json.loads(result.stdout)["episodes"]:
                    self.assertNotIn(episode["outcome"], ("diverged", "not_reached"), episode)
                    if unlatched and "interior" in episode["door"]:
                        self.assertEqual(episode["outcome"], "opened", episode)

    def test_a_setting_goes_over_a_preset_and_unknown_ones_are_told(self):
        doors = self.compose()
        self.assert_refused(run("simulate", "--door", doors, "--preset", "dorgym"), 2)
        result = run("simulate", "--door", doors, "--preset", "doorgym", "--set", "scene.physics.base=wheels")
        self.assert_refused(result, 2)
        result = run("datagen", "plan", "open", "--doors", doors, "--preset", "doorgym", "--probe", 1)
        self.assert_ends(result, 0)
        report = self.folder / "report"
        self.assert_ends(run("eval", "--doors", doors, "--preset", "rlafford", "--opener", "expert", "--seeds", 1,
                             "--out", report), 0)
        config = json.loads((report / "report.json").read_text())["provenance"]["config"]
        self.assertEqual(config["scene"]["latch"], "none")


if __name__ == "__main__":
    unittest.main(verbosity=2)

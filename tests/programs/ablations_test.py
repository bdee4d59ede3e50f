# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's ablations, trained and judged at the smallest size that exercises every step of theirs."""
import json
import unittest

from programs import ProgramTest, run

# body, handle; of each side of full.yaml that is read, and a round knob to learn from
PAIRS = (("interior_arched_01", "interior_lever_blade_01"), ("interior_arched_02", "interior_round_ball_01"),
         ("interior_planked_01", "interior_lever_cranked_03"), ("storage_arched_corner_01", "storage_knob_ball_01"))
SIZE = """about: a few episodes of each stage
rows: [{rows}]
doors: 1
seeds: 1
trainings: 1
seed: 7
settings: [{settings}, handle_epochs=1, grasp_episodes=4, sized_grasp_episodes=2, discriminator_epochs=1, grasp_epochs=1]
"""
FEW = "open_episodes=4, open_epochs=1, handle_episodes=4, knob_episodes=2, sized_handle_episodes=2"
# the opener has to open a door or two for what turns the handle before it, which on a fixed base is harder to learn
MORE = "open_episodes=8, open_epochs=6, handle_episodes=6, knob_episodes=4, sized_handle_episodes=6"


class Ablations(ProgramTest):
    def judged(self, rows: tuple, settings: str) -> dict[str, dict]:
        """Trains and judges the rows; the reports of held-out doors by row."""
        doors, self.out = self.folder / "doors", self.folder / "out"
        for body, handle in PAIRS:
            self.assert_ends(run("compose", "--body", body, "--handle", handle, "--out", doors / body), 0)
        size = self.folder / "size.yaml"
        size.write_text(SIZE.format(rows=", ".join(rows), settings=settings))
        self.assert_ends(run("benchmark", size, "--out", self.out, "--doors", doors, "--threads", 2, timeout=1500), 0)
        table = json.loads((self.out / "benchmark.json").read_text())
        self.assertEqual(tuple(row["name"] for row in table["rows"]), rows)
        return {name: json.loads((self.out / f"rows/{name}_1_test/report.json").read_text()) for name in rows}

    def test_without_disentangle_condition_and_state(self):
        report = self.judged(("without_disentangle", "without_condition", "without_state"), FEW)
        steps = {path.stem for path in (self.out / "pipeline").glob("*.json")}
        self.assertEqual({step for step in steps if step.startswith("open_data")}, {"open_data"})  # made once
        one = report["without_disentangle"]["provenance"]
        self.assertEqual(one["policy_sha256"], one["handler_sha256"])  # the same weights in both stages
        blind = json.loads((self.out / "made/opener_without_state_1/policy.json").read_text())
        self.assertEqual(blind["provenance"]["config"]["state"], "none")

    def test_without_mobile(self):
        report = self.judged(("without_mobile",), MORE)
        config = report["without_mobile"]["provenance"]["config"]
        self.assertEqual(config["scene"]["physics"]["base"], "fixed")


if __name__ == "__main__":
    unittest.main(verbosity=2)

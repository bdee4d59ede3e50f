# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's ablations, trained and judged at the smallest size that exercises every step of theirs."""
import json
import unittest

from programs import ProgramTest, run

# body, handle; of each side of full.yaml that is read, and a round knob to learn from
PAIRS = (("interior_arched_01", "interior_lever_blade_01"), ("interior_arched_02", "interior_round_ball_01"),
         ("interior_planked_01", "interior_lever_cranked_03"), ("storage_arched_corner_01", "storage_knob_ball_01"))
ROWS = ("without_disentangle", "without_condition", "without_state", "without_mobile")
SIZE = """about: a few episodes of each stage
rows: [{rows}]
doors: 1
seeds: 1
trainings: 1
seed: 7
settings: [open_episodes=4, open_epochs=1, handle_episodes=4, knob_episodes=2, sized_handle_episodes=2, handle_epochs=1,
           grasp_episodes=4, sized_grasp_episodes=2, discriminator_epochs=1, grasp_epochs=1]
"""


class Ablations(ProgramTest):
    def test_each_is_trained_and_judged(self):
        doors, out = self.folder / "doors", self.folder / "out"
        for body, handle in PAIRS:
            self.assert_ends(run("compose", "--body", body, "--handle", handle, "--out", doors / body), 0)
        size = self.folder / "size.yaml"
        size.write_text(SIZE.format(rows=", ".join(ROWS)))
        result = run("benchmark", size, "--out", out, "--doors", doors, "--threads", 2, timeout=1500)
        self.assert_ends(result, 0)
        table = json.loads((out / "benchmark.json").read_text())
        self.assertEqual(tuple(row["name"] for row in table["rows"]), ROWS)

        steps = {path.stem for path in (out / "pipeline").glob("*.json")}
        self.assertEqual({"open_data", "open_data_without_mobile_1"},
                         {step for step in steps if step.startswith("open_data")})  # what is common is made once
        report = {name: json.loads((out / f"rows/{name}_1_test/report.json").read_text()) for name in ROWS}
        one = report["without_disentangle"]["provenance"]
        self.assertEqual(one["policy_sha256"], one["handler_sha256"])  # the same weights in both stages
        config = report["without_mobile"]["provenance"]["config"]
        self.assertEqual(config["scene"]["physics"]["base"], "fixed")
        blind = json.loads((out / "made/opener_without_state_1/policy.json").read_text())
        self.assertEqual(blind["provenance"]["config"]["state"], "none")


if __name__ == "__main__":
    unittest.main(verbosity=2)

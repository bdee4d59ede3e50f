# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The policies in data/policies are whole, small, and open doors of every category that they never saw."""
import hashlib
import json
import shutil
import struct
import subprocess
import sys
import unittest

from programs import SOURCE, ProgramTest, run

POLICIES = SOURCE / "data/policies"
STAGES = {"opener": "open", "opener/pushed": "open", "handler": "handle", "grasper": "grasp", "finder": "find"}
# bodies and handles of the split full:test, and of the categories that are never trained on
DOORS = {"interior_arched_03": "interior_lever_wave_04", "interior_louvred_04": "interior_round_egg_03",
         "window_casement_03": "window_espagnolette_03", "car_sedan_01": "car_flap_03",
         "safe_box_tall_02": "safe_wheel_three_01", "safe_wall_01": "safe_key_03",
         "storage_arched_hutch_01": "storage_pull_bow_01",
         "refrigerator_arched_01": "refrigerator_latch_01"}


def tensors_of(path):
    """The name of each tensor of a safetensors file, and its bytes."""
    data = path.read_bytes()
    (size,) = struct.unpack("<Q", data[:8])
    header = json.loads(data[8 : 8 + size])
    header.pop("__metadata__", None)
    return {name: data[8 + size :][slice(*tensor["data_offsets"])] for name, tensor in header.items()}


def write_tensors(path, tensors):
    header, numbers = {}, b""
    for name, content in tensors.items():
        header[name] = {"dtype": "F16", "shape": [len(content) // 2], "data_offsets": [len(numbers), len(numbers) + len(content)]}
        numbers += content
    text = json.dumps(header).encode()
    path.write_bytes(struct.pack("<Q", len(text)) + text + numbers)


class SlimPolicy(ProgramTest):
    def slim(self, folder):
        return subprocess.run([sys.executable, SOURCE / "scripts/slim_policy.py", folder], capture_output=True, text=True)

    def test_it_takes_the_posterior_out_and_leaves_all_else(self):
        policy = self.folder / "handler"
        shutil.copytree(POLICIES / "handler", policy)
        shipped = tensors_of(policy / "policy.safetensors")
        posterior = {f"actor.{layer}.weight": bytes([i, 60, i, 61]) for i, layer in
                     enumerate(("action.0", "posterior.1", "mean", "log_variance"))}
        names = sorted([*shipped, *posterior])
        write_tensors(policy / "policy.safetensors", {name: (shipped | posterior)[name] for name in names})
        record = json.loads((policy / "policy.json").read_text())
        record["weights_sha256"] = hashlib.sha256((policy / "policy.safetensors").read_bytes()).hexdigest()
        (policy / "policy.json").write_text(json.dumps(record))
        self.assertEqual(self.slim(policy).returncode, 0)
        self.assertEqual(tensors_of(policy / "policy.safetensors"), shipped)
        found = json.loads((policy / "policy.json").read_text())
        self.assertEqual(found.pop("weights_sha256"), hashlib.sha256((policy / "policy.safetensors").read_bytes()).hexdigest())
        self.assertEqual(found, {key: value for key, value in record.items() if key != "weights_sha256"})

    def test_what_is_damaged_or_has_no_posterior_is_left_as_it_is(self):
        for name, reason in (("handler", "SHA-256"), ("grasper", "has no posterior")):
            policy = self.folder / "refused" / name
            shutil.copytree(POLICIES / name, policy)
            weights = bytearray((policy / "policy.safetensors").read_bytes())
            weights[-1] ^= 1
            (policy / "policy.safetensors").write_bytes(weights)
            result = self.slim(policy)
            self.assertEqual(result.returncode, 1)
            self.assertIn(reason, result.stderr)
            self.assertEqual((policy / "policy.safetensors").read_bytes(), weights)


class ShippedPolicies(ProgramTest):
    def test_they_are_what_their_records_say(self):
        self.assertLess(sum(path.stat().st_size for path in POLICIES.rglob("*.safetensors")), 20_000_000)
        for name, stage in STAGES.items():
            record = json.loads((POLICIES / name / "policy.json").read_text())
            self.assertEqual(record["stage"], stage)
            weights = (POLICIES / name / record["weights"]).read_bytes()
            self.assertEqual(hashlib.sha256(weights).hexdigest(), record["weights_sha256"], name)

    def test_given_the_grasp_they_open_doors_that_they_never_saw(self):
        for body, handle in DOORS.items():
            self.assert_ends(run("compose", "--body", body, "--handle", handle, "--out", self.folder / "doors" / body), 0)
        result = run("eval", "--opener", POLICIES / "opener", "--handler", POLICIES / "handler", "--doors",
                     self.folder / "doors", "--seeds", 2, "--set", "expert_reference=false", "--out", self.folder / "report")
        self.assert_ends(result, 0)
        episodes = json.loads((self.folder / "report/report.json").read_text())["episodes"]
        self.assertEqual(len(episodes), 2 * len(DOORS))
        failed = [f'{episode["door_id"]}: {episode["detail"]}' for episode in episodes if episode["outcome"] != "opened"]
        self.assertLessEqual(len(failed), 1, failed)

    def test_they_open_doors_whose_handle_nobody_tells_them(self):
        for body, handle in DOORS.items():
            self.assert_ends(run("compose", "--body", body, "--handle", handle, "--out", self.folder / "untold" / body), 0)
        result = run("eval", "--opener", POLICIES / "opener", "--handler", POLICIES / "handler", "--grasper", POLICIES / "grasper",
                     "--set", f"grasp.finder={POLICIES / 'finder'}", "--doors", self.folder / "untold", "--seeds", 1,
                     "--set", "expert_reference=false", "--out", self.folder / "untold_report")
        self.assert_ends(result, 0)
        report = json.loads((self.folder / "untold_report/report.json").read_text())
        found_by = json.loads((POLICIES / "finder/policy.json").read_text())["weights_sha256"]
        self.assertEqual(report["provenance"]["finder_sha256"], found_by)
        failed = [f'{episode["door_id"]}: {episode["detail"]}' for episode in report["episodes"] if episode["outcome"] != "opened"]
        self.assertLessEqual(len(failed), 1, failed)

    def test_doors_of_other_kinds_open_without_being_told(self):
        kinds = {"right": ["hinge_side=right"], "pushed": ["opening=push"], "reversed": ["handle_sense=reversed"]}
        for name, settings in kinds.items():
            options = [word for setting in settings for word in ("--set", setting)]
            self.assert_ends(run("compose", "--body", "interior_louvred_04", "--handle", "interior_lever_wave_04",
                                 "--out", self.folder / "kinds" / name, *options), 0)
        untold = [word for what in ("side", "turning", "opening") for word in ("--set", f"policy.{what}=auto")]
        result = run("eval", "--opener", POLICIES / "opener", "--handler", POLICIES / "handler", "--grasper", POLICIES / "grasper",
                     "--doors", self.folder / "kinds", "--seeds", 1, *untold, "--set", "grasps=4", "--set", "expert_reference=false",
                     "--out", self.folder / "kinds_report")
        self.assert_ends(result, 0)
        episodes = json.loads((self.folder / "kinds_report/report.json").read_text())["episodes"]
        self.assertEqual([episode["outcome"] for episode in episodes], ["opened"] * 3, episodes)


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Trained policies in the rules' place while data are collected: recorded, checked, the same bytes."""
import hashlib
import json
import pathlib
import shutil
import tarfile
import unittest

from programs import ProgramTest, run


def digests(folder: pathlib.Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def members(dataset: pathlib.Path) -> list[tuple[str, bytes]]:
    found = []
    for path in sorted(dataset.rglob("*.tar")):
        with tarfile.open(path) as shard:
            found += [(entry.name, shard.extractfile(entry).read()) for entry in shard if entry.isfile()]
    return found


def actions(dataset: pathlib.Path) -> list[bytes]:
    return [member for name, member in members(dataset) if name.endswith(".action.npy")]


def sha256(path: pathlib.Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


class TrainedCollection(ProgramTest):
    def collect(self, stage: str, out: str, threads: int, *options: object, episodes: int = 2):
        return run("datagen", stage, "--doors", self.folder / "door", "--out", self.folder / out, "--episodes", episodes,
                   "--seed", 3, "--set", "preview=false", "-j", threads, *options)

    def train(self, stage: str, seed: int, out: str, data: str = "") -> pathlib.Path:
        """A policy that has seen a handful of samples once."""
        self.assert_ends(run("train", stage, "--data", self.folder / (data or f"data_{stage}"), "--out", self.folder / out,
                             "--epochs", 1, "--seed", seed, "--threads", 2), 0)
        return self.folder / out

    def test_both_policies_act_are_recorded_and_are_the_only_ones_to_go_on_with(self):
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_02",
                             "--out", self.folder / "door"), 0)
        self.assert_ends(self.collect("open", "data_open", 2), 0)
        opener = self.train("open", 1, "opener")
        self.assert_ends(self.collect("handle", "data_handle", 2), 0)
        handler = self.train("handle", 1, "handler")

        policies = ["--opener", opener, "--handler", handler]
        self.assert_ends(self.collect("grasp", "one", 1, *policies), 0)
        self.assert_ends(self.collect("grasp", "two", 2, *policies), 0)
        files = digests(self.folder / "one")
        self.assertGreater(sum(name.endswith(".tar") for name in files), 0)
        self.assertEqual(files, digests(self.folder / "two"))

        recorded = json.loads((self.folder / "one/provenance.json").read_text())["policies"]
        self.assertEqual([(policy["stage"], policy["policy_sha256"]) for policy in recorded],
                         [("handle", sha256(handler / "policy.json")), ("open", sha256(opener / "policy.json"))])
        self.assert_ends(run("dataset", "verify", self.folder / "one", "--regenerate", "100%", "--doors",
                             self.folder / "door", *policies), 0)

        # a learner drives, and is corrected and recorded; what it led to can be made and looked at again
        learner = ["--learner", handler, "--set", "sampled_grasps=0.5", "--set", "learner_decisions=2"]
        self.assert_ends(self.collect("handle", "corrected", 2, *learner, "--set", "preview=true", episodes=4), 0)
        recorded = json.loads((self.folder / "corrected/provenance.json").read_text())["policies"]
        self.assertEqual([policy["policy_sha256"] for policy in recorded], [sha256(handler / "policy.json")])
        self.assert_ends(run("dataset", "verify", self.folder / "corrected", "--regenerate", "50%", "--doors",
                             self.folder / "door", "--learner", handler), 0)
        self.assert_ends(run("dataset", "re-observe", self.folder / "corrected", "--doors", self.folder / "door",
                             "--out", self.folder / "again"), 0)
        tars = {name: digest for name, digest in digests(self.folder / "corrected").items() if name.endswith(".tar")}
        self.assertEqual(tars, {name: digest for name, digest in digests(self.folder / "again").items()
                                if name.endswith(".tar")})

        # its clouds hold what was seen before the hand came, unless told otherwise, which the learner then is not made for
        for name, member in members(self.folder / "corrected"):
            if name.endswith(".meta.json"):
                self.assertEqual(json.loads(member)["remembered_finer"], 2)
        refused = self.collect("handle", "forgetful", 1, *learner, "--set", "remembered.finer=0")
        self.assert_refused(refused, 2)
        self.assertIn("remembered.finer=2", refused.stderr)

        # a grasp policy's own grasps are tried: none of them is drawn by chance, and they can be made again
        grasper = self.train("grasp", 1, "grasper", data="one")
        self.assert_ends(self.collect("grasp", "own", 2, *policies, "--learner", grasper), 0)
        recorded = json.loads((self.folder / "own/provenance.json").read_text())["policies"]
        self.assertEqual([policy["stage"] for policy in recorded], ["handle", "open", "grasp"])
        for name, member in members(self.folder / "own"):
            if name.endswith(".meta.json"):
                self.assertEqual(json.loads(member)["policies"]["grasp"]["policy_sha256"],
                                 sha256(grasper / "policy.json"))
        self.assertNotEqual(actions(self.folder / "one"), actions(self.folder / "own"))
        self.assert_ends(run("dataset", "verify", self.folder / "own", "--regenerate", "100%", "--doors",
                             self.folder / "door", *policies, "--learner", grasper), 0)

        # another opener is not the one that the data set was begun with
        other = self.train("open", 2, "other")
        changed = ["--opener", other, "--handler", handler]
        refused = self.collect("grasp", "one", 1, *changed)
        self.assert_refused(refused, 2)
        self.assertIn(sha256(opener / "policy.json"), refused.stderr)
        refused = run("dataset", "verify", self.folder / "one", "--regenerate", "100%", "--doors",
                      self.folder / "door", *changed)
        self.assert_refused(refused, 1, 2)
        self.assertIn("open", refused.stderr)
        self.assertEqual(files, digests(self.folder / "one"))

        # nor is one whose weights are not those of its record
        stale = self.folder / "stale"
        shutil.copytree(opener, stale)
        shutil.copy(other / "policy.safetensors", stale / "policy.safetensors")
        refused = self.collect("grasp", "three", 1, "--opener", stale)
        self.assert_refused(refused, 3)
        self.assertIn("its SHA-256 is not the one in", refused.stderr)
        self.assertFalse((self.folder / "three").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)

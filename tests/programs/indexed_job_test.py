# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The Kubernetes example: its container's command for every completion index gives the bytes of one process."""
import hashlib
import os
import pathlib
import subprocess
import unittest

import yaml

from programs import BINARY_DIR, SOURCE, ProgramTest, run

EPISODES = 6


def digests(folder: pathlib.Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class IndexedJob(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.job = yaml.safe_load((SOURCE / "docs/examples/collect_job.yaml").read_text())
        self.spec = self.job["spec"]
        self.container = self.spec["template"]["spec"]["containers"][0]

    def command(self, out: pathlib.Path) -> list[str]:
        """The container's, here and at small size."""
        here = {"--doors": f"--doors={self.folder / 'doors'}", "--out": f"--out={out}",
                "--episodes": f"--episodes={EPISODES}", "--threads": "--threads=1"}
        words = [here.get(word.split("=")[0], word) for word in self.container["command"]]
        self.assertEqual(words[0], "doorforge")
        small = ["--set", "collection.episodes_per_shard=2", "--set", "preview=false", "--set", "cloud.point_count=64"]
        return [str(BINARY_DIR / "bin/doorforge"), *words[1:], *small]

    def run_index(self, out: pathlib.Path, index: object) -> subprocess.CompletedProcess:
        environment = {name: value for name, value in os.environ.items() if not name.startswith("SLURM_")}
        environment.pop("JOB_COMPLETION_INDEX", None)
        if index is not None:
            environment["JOB_COMPLETION_INDEX"] = str(index)
        return subprocess.run(self.command(out), capture_output=True, text=True, env=environment, timeout=300)

    def test_the_manifest_is_an_indexed_job_with_an_index_for_each_task(self):
        self.assertEqual((self.job["apiVersion"], self.job["kind"]), ("batch/v1", "Job"))
        self.assertEqual(self.spec["completionMode"], "Indexed")
        self.assertIn(f"--tasks={self.spec['completions']}", self.container["command"])
        # retries of single indices are only allowed where pods are not restarted in place
        self.assertEqual(self.spec["template"]["spec"]["restartPolicy"], "Never")
        volumes = {volume["name"] for volume in self.spec["template"]["spec"]["volumes"]}
        self.assertEqual({mount["name"] for mount in self.container["volumeMounts"]}, volumes)

    def test_all_indices_and_a_merge_give_the_bytes_of_one_process(self):
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_02",
                             "--out", self.folder / "doors/one"), 0)
        tasks, single = self.folder / "tasks", self.folder / "single"
        for index in reversed(range(self.spec["completions"])):
            self.assert_ends(self.run_index(tasks, index), 0)
        self.assert_ends(run("dataset", "merge", tasks), 0)
        alone = [word for word in self.command(single) if not word.startswith("--tasks")]
        self.assertEqual(subprocess.run(alone, capture_output=True, timeout=300).returncode, 0)
        files = digests(single)
        self.assertEqual(sum(name.endswith(".tar") for name in files), EPISODES // 2)
        self.assertEqual(digests(tasks), files)

    def test_without_an_index_or_with_one_too_many_nothing_is_written(self):
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_02",
                             "--out", self.folder / "doors/one"), 0)
        for index in (None, "", "x", self.spec["completions"]):
            self.assert_refused(self.run_index(self.folder / "nothing", index), 2)
        self.assertFalse((self.folder / "nothing").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/python.md run, with what Debian has; PYTHONPATH holds the package.

    examples_test.py BUILD    # the build tree, whose programs collect
"""
import contextlib
import io
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import torch

import doorforge

ROOT = pathlib.Path(__file__).parents[2]
BUILD = pathlib.Path(sys.argv.pop())


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.door = str(pathlib.Path(cls.scratch.name) / "door")
        doorforge.compose("interior_flush_01", "interior_lever_tube_01").save(cls.door)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.scratch.cleanup()

    def run_example(self, name: str, *words: str) -> str:
        done = subprocess.run([sys.executable, "-B", str(ROOT / "docs" / "examples" / name), *words], capture_output=True,
                              text=True, timeout=600, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"overall +\d+\.\d %")
        return done.stdout

    def test_a_function_is_judged(self) -> None:
        self.assertIn("opening: callable", self.run_example("callable_policy.py", self.door))

    def test_a_network_is_trained_from_shards_and_judged(self) -> None:
        told = self.run_example("clone_policy.py", str(ROOT / "tests" / "golden" / "dataset_v1"), self.door, "--epochs", "6",
                                "--batch", "16")
        losses = [float(loss) for loss in re.findall(r"loss (\d+\.\d+)", told)]
        self.assertEqual(len(losses), 6)
        self.assertLess(losses[-1], 0.8 * losses[0])

    def test_a_network_learns_from_pictures_and_is_shown_such(self) -> None:
        data = str(pathlib.Path(self.scratch.name) / "pictures")
        subprocess.run([BUILD / "bin/doorforge", "datagen", "open", "--doors", self.door, "--out", data, "--episodes", "2",
                        "--set", "scene.appearance=full", "--set", "pictures.cameras=[{name: own, at: scene}]",
                        "--set", "pictures.streams=[rgb, depth32]", "--set", "pictures.samples=1"],
                       capture_output=True, check=True, timeout=600)
        told = self.run_example("clone_images.py", data, self.door, "--epochs", "3", "--batch", "8")
        losses = [float(loss) for loss in re.findall(r"loss (\d+\.\d+)", told)]
        self.assertEqual(len(losses), 3)
        self.assertLess(losses[-1], losses[0])
        self.assertNotIn("policy_failed", told)
        self.goes_on_where_it_was_stopped(data)

    def goes_on_where_it_was_stopped(self, data: str) -> None:
        """A training that ends after its first epoch, and goes on, has the weights of one that was left alone."""
        sys.path.insert(0, str(ROOT / "docs" / "examples"))
        import clone_images  # pylint: disable=import-error,import-outside-toplevel
        decisions = clone_images.Decisions(data, names=("rgb_own", "depth32_own", "proprio", "action"))
        checkpoint, keep = str(pathlib.Path(self.scratch.name) / "checkpoint"), clone_images.keep

        def keep_and_end(path: str, value: object) -> None:
            keep(path, value)
            raise KeyboardInterrupt

        clone_images.keep = keep_and_end
        with self.assertRaises(KeyboardInterrupt):
            clone_images.train(decisions, 2, 8, 7, checkpoint)
        clone_images.keep = keep
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            resumed = clone_images.train(decisions, 2, 8, 7, checkpoint).state_dict()
        self.assertNotIn("epoch 0", told.getvalue())
        alone = clone_images.train(decisions, 2, 8, 7, "").state_dict()
        for name, value in alone.items():
            self.assertTrue(torch.equal(value, resumed[name]), name)


if __name__ == "__main__":
    unittest.main()

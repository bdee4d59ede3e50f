# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Options of `doorforge datagen` that must be refused before anything is written."""
import unittest

from programs import ProgramTest, run


class CollectionOptions(ProgramTest):
    def collect(self, *more: object):
        return run("datagen", "open", "--doors", self.folder, "--out", self.folder / "refused", "--episodes", 1, *more)

    def test_an_empty_value_is_not_an_option_that_was_left_out(self):
        """As of `--task "$UNSET"`: all episodes instead of a share, or the rule instead of the policy."""
        for option in ("--task", "--opener", "--handler", "--learner", "--robot", "--config", "--set", "--slurm"):
            with self.subTest(option):
                result = self.collect(option, "")
                self.assert_refused(result, 2)
                self.assertIn(f"{option}: its value is empty", result.stderr)
        self.assertFalse((self.folder / "refused").exists())

    def test_a_file_is_no_folder_for_a_dataset(self):
        door = self.folder / "door"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", door), 0)
        (self.folder / "refused").write_text("a file")
        result = self.collect()
        self.assert_refused(result, 2)
        self.assertIn("refused: is a file; --out takes a folder", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

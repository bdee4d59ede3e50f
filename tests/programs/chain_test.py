# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The chain from parts to a report, at the smallest size that exercises every step."""
import hashlib
import json
import pathlib
import unittest

from programs import ProgramTest, run


def digests(folder: pathlib.Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.suffix in {".tar"} or path.name.endswith(".index.json")}


class Chain(ProgramTest):
    def test_the_quick_run_ends_with_a_report_and_its_shards_do_not_depend_on_threads(self):
        out = self.folder / "quick"
        result = run("quickstart", "--out", out, "--episodes", 6, "--epochs", 1, "--threads", 2, timeout=1500)
        self.assert_ends(result, 0)
        self.assertIn(str(out / "report/report.html"), result.stdout)
        report = json.loads((out / "report/report.json").read_text())
        overall = report["success"]["overall"]
        self.assertGreater(overall["episodes"], 0)
        self.assertLessEqual(overall["low"], overall["rate"])
        self.assertLessEqual(overall["rate"], overall["high"])
        page = (out / "report/report.html").read_text()
        self.assertIn("data:image/png;base64,", page)

        again = self.folder / "again"
        self.assert_ends(run("datagen", "open", "--doors", out / "doors/train", "--out", again,
                             "--episodes", 6, "--seed", 7, "--threads", 1, timeout=900), 0)
        self.assertGreater(len(digests(again)), 1)
        self.assertEqual(digests(out / "data"), digests(again))

        self.assert_ends(run("quickstart", "--out", out), 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What scripts/keep_reports.py keeps of a training names no place of the machine that made it; nor does what is kept already."""
import gzip
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLACE = re.compile(r"(^|[\s=:\"'])/\w")
EPISODE = {"door_id": "a__b", "category": "safe", "seed": 1, "episode": 0, "outcome": "opened", "peak_hinge_rad": 0.123456, "detail": "well"}


def texts(value):
    if isinstance(value, dict):
        return [text for entry in value.values() for text in texts(entry)]
    if isinstance(value, list):
        return [text for entry in value for text in texts(entry)]
    return [value] if isinstance(value, str) else []


class KeptReports(unittest.TestCase):
    def test_the_places_of_the_machine_go_and_the_rest_stays(self):
        with tempfile.TemporaryDirectory() as scratch:
            run, out = pathlib.Path(scratch) / "run", pathlib.Path(scratch) / "kept"
            (run / "report").mkdir(parents=True)
            (run / "report.log").write_text("beside it")
            provenance = {"command": "doorforge eval --opener /somewhere/p1/opener --doors=/elsewhere/doors --split=full:test --set base=fixed",
                          "inputs": ["/somewhere/p1/open_data", "1/2 of it"]}
            report = {"schema": "doorforge.report", "schema_version": 9, "provenance": provenance, "doors": ["a__b"], "episodes": [EPISODE],
                      "expert_episodes": []}
            (run / "report/report.json").write_text(json.dumps(report))
            subprocess.run([sys.executable, ROOT / "scripts/keep_reports.py", run, out], check=True)
            self.assertEqual([path.name for path in out.iterdir()], ["report.json.gz"])
            kept = json.loads(gzip.decompress((out / "report.json.gz").read_bytes()))
        self.assertEqual(kept["provenance"], {"command": "doorforge eval --opener opener --doors=doors --split=full:test --set base=fixed",
                                              "inputs": ["open_data", "1/2 of it"]})
        self.assertEqual(kept["episodes"], [{**EPISODE, "peak_hinge_rad": 0.1235, "detail": ""}])

    def test_what_is_in_the_repository_names_none(self):
        kept = sorted((ROOT / "docs/results/trainings").glob("*/*.json.gz"))
        self.assertTrue(kept)
        for path in kept:
            found = [text for text in texts(json.loads(gzip.decompress(path.read_bytes()))) if PLACE.search(text)]
            self.assertEqual(found, [], path)


if __name__ == "__main__":
    unittest.main()

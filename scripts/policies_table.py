#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of docs/policies.md from the reports of several trainings.

    scripts/policies_table.py run1 run2 run3
    scripts/policies_table.py docs/results/trainings/*

Each folder is the --out of `doorforge pipeline paper`, with another seed, or what scripts/keep_reports.py kept of it. A cell is the
mean over the trainings in per cent, in brackets its 95 % interval for other bodies and handles, and after +- the deviation
between trainings.
"""
import argparse
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROWS = {"all learned, one grasp": "report", "all learned, up to three grasps": "report_retry", "grasp given": "report_given_grasp",
        "the expert": "expert"}
SIDES = {"": "unseen shapes", "_families": "unseen families", "_unseen": "unseen categories", "_validation": "validation",
         "_objects": "the paper's objects"}
COLUMNS = ("interior", "window", "car", "safe", "storagefurniture", "storagefurniture/latched", "storagefurniture/unlatched",
           "refrigerator", "mean of categories")


def report_of(run: pathlib.Path, name: str, scratch: pathlib.Path) -> pathlib.Path | None:
    """The report of that name, unpacked where it is packed."""
    if (run / name / "report.json").exists():
        return run / name / "report.json"
    packed = run / f"{name}.json.gz"
    if not packed.exists():
        return None
    unpacked = scratch / f"{run.resolve().name}_{name}.json"
    unpacked.write_bytes(gzip.decompress(packed.read_bytes()))
    return unpacked


def summary(program: pathlib.Path, reports: list[pathlib.Path]) -> dict:
    result = subprocess.run([program, "report", "--json", *reports], check=True, capture_output=True, text=True)
    return json.loads(result.stdout)


def cell(entry: dict | None) -> str:
    if entry is None:
        return ""
    interval = f" ({100 * entry['low']:.0f} - {100 * entry['high']:.0f})" if "low" in entry else ""
    spread = f" ± {100 * entry['deviation']:.1f}" if len(entry["rates"]) > 1 else ""
    return f"{100 * entry['mean']:.1f}{interval}{spread}"


def lines(program: pathlib.Path, runs: list[pathlib.Path], scratch: pathlib.Path) -> list[str]:
    table = ["| | " + " | ".join(COLUMNS) + " |", "|" + "---|" * (len(COLUMNS) + 1)]
    for row, report in ROWS.items():
        for suffix, side in SIDES.items():
            reports = [found for run in runs if (found := report_of(run, report + suffix, scratch))]
            if not reports:
                continue
            found = summary(program, reports[:1] if row == "the expert" else reports)  # who is not trained is the same in each
            cells = {**found["success"], "mean of categories": found["mean_of_categories"]}
            table.append(f"| {row}, {side} | " + " | ".join(cell(cells.get(column)) for column in COLUMNS) + " |")
    return table


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/doorforge")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        print("\n".join(lines(options.program, options.runs, pathlib.Path(scratch))))
    return 0


if __name__ == "__main__":
    sys.exit(main())

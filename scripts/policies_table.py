#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of docs/policies.md from the reports of several trainings.

    scripts/policies_table.py run1 run2 run3

Each folder is the --out of `doorforge pipeline paper`, with another seed. A cell is the mean over the trainings in per cent, in
brackets its 95 % interval for other bodies and handles, and after +- the deviation between trainings.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROWS = {"all learned": ("report", "report_families", "report_unseen"),
        "grasp given": ("report_given_grasp", "report_given_grasp_families", "report_given_grasp_unseen")}
SIDES = ("unseen shapes", "unseen families", "unseen categories")
COLUMNS = ("interior", "window", "car", "safe", "storagefurniture", "storagefurniture/latched", "storagefurniture/unlatched",
           "refrigerator", "mean of categories")


def summary(program: pathlib.Path, folders: list[pathlib.Path], report: str) -> dict:
    command = [program, "report", "--json", *(folder / report for folder in folders)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def cell(entry: dict | None) -> str:
    if entry is None:
        return ""
    interval = f" ({100 * entry['low']:.0f} - {100 * entry['high']:.0f})" if "low" in entry else ""
    spread = f" ± {100 * entry['deviation']:.1f}" if len(entry["rates"]) > 1 else ""
    return f"{100 * entry['mean']:.1f}{interval}{spread}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/doorforge")
    options = parser.parse_args()
    print("| | " + " | ".join(COLUMNS) + " |\n|" + "---|" * (len(COLUMNS) + 1))
    for row, reports in ROWS.items():
        for side, report in zip(SIDES, reports):
            found = summary(options.program, options.runs, report)
            cells = {**found["success"], "mean of categories": found["mean_of_categories"]}
            print(f"| {row}, {side} | " + " | ".join(cell(cells.get(column)) for column in COLUMNS) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())

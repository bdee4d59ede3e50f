#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Keeps what the table of docs/policies.md is made of: the episodes of a training's reports, packed.

    scripts/keep_reports.py run docs/results/trainings/seed1

`run` is the --out of `doorforge pipeline paper`. Each report*/report.json becomes NAME.json.gz, without the lists of training doors,
the curves, the words about what went well, and the places of the machine; the expert's episodes become reports of their own, expert*.json.gz.
scripts/policies_table.py reads the folder as it does the run's. The same report gives the same bytes.
"""
import argparse
import gzip
import json
import pathlib
import re

KEPT = ("door_id", "category", "seed", "episode", "outcome", "opening_actions", "peak_hinge_rad", "peak_handle_rad", "simulated_s",
        "handle_done", "peak_force_n", "peak_net_force_n", "state_sha256")


def without_places(value: object) -> object:
    """Folders of the machine that made it go: of an absolute path its last name stays."""
    if isinstance(value, dict):
        return {key: without_places(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [without_places(entry) for entry in value]
    return re.sub(r"(^|[\s=:\"'])/(?:[^\s/\"']+/)*([^\s/\"']+)", r"\1\2", value) if isinstance(value, str) else value


def rounded(value: object) -> object:
    return round(value, 4) if isinstance(value, float) else value


def slim(report: dict, episodes: list[dict]) -> dict:
    kept = {key: report[key] for key in ("schema", "schema_version", "provenance", "doors")}
    kept["episodes"] = [{**{key: rounded(row[key]) for key in KEPT if key in row}, "detail": row["detail"] if row["outcome"] != "opened" else ""}
                        for row in episodes]
    return {**without_places(kept), "trained_on": {"bodies": [], "handles": []}, "training_doors": [], "losses": [], "expert_episodes": []}


def write(path: pathlib.Path, report: dict) -> None:
    text = json.dumps(report, sort_keys=True, separators=(",", ":"))
    path.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for path in sorted(options.run.glob("report*/report.json")):
        folder, report = path.parent, json.loads(path.read_text())
        write(options.out / f"{folder.name}.json.gz", slim(report, report["episodes"]))
        if report["expert_episodes"]:
            write(options.out / f"{folder.name.replace('report', 'expert')}.json.gz", slim(report, report["expert_episodes"]))


if __name__ == "__main__":
    main()

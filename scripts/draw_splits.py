#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data/splits/full.yaml: the whole catalogue, split as in the paper.

    scripts/draw_splits.py             writes the file
    scripts/draw_splits.py --check     writes nothing; exit code 1 if the file would differ

Interior, window, car and safe are trained on. Of their parts of one category, role and mechanism,
sorted by id, every third is held out, so that a test door has a body and a handle that no training
door had. Storage furniture and refrigerators are never trained on.
"""
import argparse
import pathlib
import re
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
TRAINED = ("interior", "window", "car", "safe")
UNSEEN = ("storagefurniture", "refrigerator")
HOLD_OUT_EVERY = 3
HEADER = """# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: CC0-1.0
#
# The whole catalogue as the paper splits its own: parts to train on, parts of the same categories to
# test on, and two categories that are never trained on. No part is on two sides. Written by
# scripts/draw_splits.py.
schema: doorforge.split
schema_version: 1
"""


def mechanisms():
    """Family -> mechanism of its handles, from the tables at the end of the families' sources."""
    found = {}
    for source in sorted((ROOT / "asset_tools/door/src").glob("*.cpp")):
        for family, name in re.findall(r'\{"(\w+)",\s*PartRole::kHandle,\s*Mechanism::k(\w+),', source.read_text()):
            found[family] = name
    return found


def parts(category):
    """Groups of ids that are split alike, sorted."""
    mechanism = mechanisms()
    groups = {}
    for path in sorted((ROOT / "data/catalog" / category).glob("*/*.yaml")):
        recipe = yaml.safe_load(path.read_text())
        role = path.parent.name
        kind = mechanism[recipe["family"]] if role == "handles" else ""
        groups.setdefault((role, kind), []).append(recipe["id"])
    return groups


def split():
    sides = {"train": [], "test": [], "unseen_categories": []}
    for category in TRAINED:
        for _, ids in sorted(parts(category).items()):
            for index, recipe_id in enumerate(ids):
                held_out = index % HOLD_OUT_EVERY == HOLD_OUT_EVERY - 1
                sides["test" if held_out else "train"].append(recipe_id)
    for category in UNSEEN:
        for _, ids in sorted(parts(category).items()):
            sides["unseen_categories"] += ids
    return sides


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    sides = split()
    text = HEADER + "".join(f"{side}:\n" + "".join(f"  - {i}\n" for i in ids) for side, ids in sides.items())
    path = ROOT / "data/splits/full.yaml"
    same = path.exists() and path.read_text() == text
    if args.check:
        print(f"{path}: {'as drawn' if same else 'differs from what is drawn'}")
        return 0 if same else 1
    path.write_text(text)
    print(", ".join(f"{side} {len(ids)}" for side, ids in sides.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())

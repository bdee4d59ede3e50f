#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data/splits/full.yaml and families.yaml: the catalogue, split as in the paper, and whole families held out.

    scripts/draw_splits.py             writes the files
    scripts/draw_splits.py --check     writes nothing; exit code 1 if a file would differ

Interior, window, car and safe are trained on; storage furniture and refrigerators never are. Parts of one category,
role and mechanism are a group. Of each group with three or more generator families, sorted by name, the third family is
held out whole: these are the test side of families.yaml. Of the other parts of a group, sorted by id, every third is on
the test side of full.yaml, and every sixth of the rest on the validation side of both, where settings are chosen. What
then remains is the training side of both, so that one policy is judged on all sides.
"""
import argparse
import pathlib
import re
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
TRAINED = ("interior", "window", "car", "safe")
UNSEEN = ("storagefurniture", "refrigerator")
HELD_OUT_FAMILY = 2  # the third by name
TEST_EVERY = 3
VALIDATE_EVERY = 6
HEADER = """# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: CC0-1.0
#
{about}
# Written by scripts/draw_splits.py.
schema: doorforge.split
schema_version: 2
"""
ABOUT = {
    "full": """# The catalogue as the paper splits its own: parts to train on, parts to choose settings by, parts of the same families to
# test on, and two categories that are never trained on. No part is on two sides. The families that families.yaml holds
# out are on none.""",
    "families": """# Whole generator families held out: the test side's bodies and handles are of families of which no part is on the training
# or the validation side. Those two are the same as in full.yaml.""",
}


def mechanisms():
    """Family -> mechanism of its handles, from the tables at the end of the families' sources."""
    found = {}
    for source in sorted((ROOT / "asset_tools/catalogue/src").rglob("*.cpp")):
        for family, name in re.findall(r'\{"(\w+)",\s*PartRole::kHandle,\s*Mechanism::k(\w+),', source.read_text()):
            found[family] = name
    return found


def groups_of(category):
    """Groups of (family, id) that are split alike, each sorted by id, in the order of role and mechanism."""
    mechanism = mechanisms()
    groups = {}
    for path in sorted((ROOT / "data/catalog" / category).glob("*/*.yaml")):
        recipe = yaml.safe_load(path.read_text())
        role = path.parent.name
        kind = mechanism[recipe["family"]] if role == "handles" else ""
        groups.setdefault((role, kind), []).append((recipe["family"], recipe["id"]))
    return [sorted(parts, key=lambda part: part[1]) for _, parts in sorted(groups.items())]


def held_out_family(parts):
    families = sorted({family for family, _ in parts})
    return families[HELD_OUT_FAMILY] if len(families) > HELD_OUT_FAMILY else None


def splits():
    train, validation, test, families, unseen = [], [], [], [], []
    for category in TRAINED:
        for parts in groups_of(category):
            held_out = held_out_family(parts)
            families += [part for family, part in parts if family == held_out]
            known = [part for family, part in parts if family != held_out]
            test += known[TEST_EVERY - 1::TEST_EVERY]
            rest = [part for index, part in enumerate(known) if index % TEST_EVERY != TEST_EVERY - 1]
            validation += rest[VALIDATE_EVERY // 2::VALIDATE_EVERY]
            train += [part for index, part in enumerate(rest) if index % VALIDATE_EVERY != VALIDATE_EVERY // 2]
    for category in UNSEEN:
        for parts in groups_of(category):
            unseen += [part for _, part in parts]
    known_sides = {"train": train, "validation": validation}
    return {"full": {**known_sides, "test": test, "unseen_categories": unseen},
            "families": {**known_sides, "test": families, "unseen_categories": []}}


def text_of(name, sides):
    listed = "".join(f"{side}:\n" + "".join(f"  - {part}\n" for part in parts) if parts else f"{side}: []\n"
                     for side, parts in sides.items())
    return HEADER.format(about=ABOUT[name]) + listed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    all_same = True
    for name, sides in splits().items():
        path = ROOT / f"data/splits/{name}.yaml"
        text = text_of(name, sides)
        same = path.exists() and path.read_text() == text
        all_same = all_same and same
        if args.check:
            print(f"{path}: {'as drawn' if same else 'differs from what is drawn'}")
        else:
            path.write_text(text)
            print(f"{name}: " + ", ".join(f"{side} {len(parts)}" for side, parts in sides.items()))
    return 0 if all_same or not args.check else 1


if __name__ == "__main__":
    sys.exit(main())

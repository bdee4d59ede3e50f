#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the catalogue's recipes from the ranges of its families.

    scripts/draw_recipes.py            writes the recipes that are missing
    scripts/draw_recipes.py --redraw   writes all anew
    scripts/draw_recipes.py --check    writes nothing; exit code 1 if a recipe is missing or would differ
    scripts/draw_recipes.py --candidates 8 --category safe --out DIR
                                       draws every recipe 8 times, as DIR/catalog/.../ID--0.yaml to ID--7.yaml

data/families/CATEGORY_ROLE.yaml (ROLE: bodies or handles) is a list of entries:

    - family: lever_straight
      stem: interior_lever_tube    # ids are interior_lever_tube_01, _02, ...
      count: 12
      first: 3                     # optional: the first number, 1 if left out
      kept: 1                      # optional: the first so many are written by hand and stay
      parameters:
        length_m: {uniform: [0.11, 0.14]}      # rounded to 0.1 mm
        columns: {integer: [1, 3]}
        finish: {choice: [brushed_steel, brass]}
        squareness: 4                          # any other value is fixed

Every parameter has a stream of its own, from the recipe's id and the parameter's place: adding a
parameter or an entry leaves the other values as they are.

data/families/draws.yaml says which draw of a recipe is taken where it is not the first, 0. They are
chosen so that parts differ and keep to the measured sizes (benchmarks/choose_recipes.cpp):

    scripts/draw_recipes.py --choose build/release/bin/choose_recipes --category window

draws every recipe of a window several times (CANDIDATES below), lets the program choose, and writes
draws.yaml and the recipes. --role bodies or handles takes only those. --side test chooses only for the
parts on that side of data/splits/full.yaml, so that what was trained on stays as it is; --rounds 3
lets each recipe choose three times instead of twice.
"""
import argparse
import hashlib
import pathlib
import subprocess
import sys
import tempfile

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADER = ("# SPDX-FileCopyrightText: 2026 The doorforge authors\n"
          "# SPDX-License-Identifier: CC0-1.0\n")
DRAWS = ROOT / "data/families/draws.yaml"
DRAWS_HEADER = HEADER + """
# Which draw of a recipe is taken where it is not 0; chosen so that parts differ, see
# scripts/draw_recipes.py.
"""
# How many draws --choose makes of a recipe; 8 of all others.
CANDIDATES = {"car_bodies": 10, "car_handles": 24, "interior_bodies": 6, "interior_handles": 40,
              "refrigerator_bodies": 400,
              "storagefurniture_bodies": 40, "window_bodies": 30, "window_handles": 14}
ENTRY_KEYS = {"family", "stem", "count", "first", "kept", "parameters"}


def unit(stream):
    """A number in [0, 1) that depends on the stream's name alone."""
    return int.from_bytes(hashlib.sha256(stream.encode()).digest()[:6], "big") / 2**48


def draw(value, stream):
    if isinstance(value, list):
        return [draw(item, f"{stream}/{i}") for i, item in enumerate(value)]
    if not isinstance(value, dict):
        return value
    if set(value) == {"uniform"}:
        low, high = value["uniform"]
        return round(low + (high - low) * unit(stream), 4)
    if set(value) == {"integer"}:
        low, high = value["integer"]
        return low + int(unit(stream) * (high - low + 1))
    if set(value) == {"choice"}:
        chosen = value["choice"][int(unit(stream) * len(value["choice"]))]
        return draw(chosen, stream + "/chosen")
    return {key: draw(item, f"{stream}/{key}") for key, item in value.items()}


def recipe_text(entry, recipe_id, number, name=None):
    """Draw `number` of a recipe; the file and its id are called `name` if it is given."""
    stream = f"{recipe_id}--{number}" if number else recipe_id
    recipe = {"schema": "doorforge.recipe", "schema_version": 1, "id": name or recipe_id,
              "family": entry["family"], "license": "CC0-1.0",
              "parameters": draw(entry.get("parameters", {}), stream)}
    return HEADER + yaml.safe_dump(recipe, sort_keys=False, default_flow_style=None, width=100)


def recipes(families_file):
    """Category, role, id and entry of each recipe; the entry is None for those written by hand."""
    category, role = families_file.stem.rsplit("_", 1)
    if role not in ("bodies", "handles"):
        sys.exit(f"{families_file}: expected a name like window_bodies.yaml")
    for entry in yaml.safe_load(families_file.read_text()):
        unknown = set(entry) - ENTRY_KEYS
        if unknown:
            sys.exit(f"{families_file}: unknown key {sorted(unknown)[0]!r}; allowed: {sorted(ENTRY_KEYS)}")
        first = entry.get("first", 1)
        for number in range(first, first + entry["count"]):
            kept = number < first + entry.get("kept", 0)
            yield f"{category}/{role}", f"{entry['stem']}_{number:02d}", None if kept else entry


def families_files(category, role):
    return sorted((ROOT / "data/families").glob(f"{category or '*'}_{role or '*'}.yaml"))


def write_candidates(files, count, out, only=None):
    """`count` draws of every recipe (of those in `only`, if given), and all others as they are."""
    for families_file in files:
        for folder, recipe_id, entry in recipes(families_file):
            place = out / "catalog" / folder
            place.mkdir(parents=True, exist_ok=True)
            if entry is None or (only is not None and recipe_id not in only):
                (place / f"{recipe_id}.yaml").write_text(
                    (ROOT / "data/catalog" / folder / f"{recipe_id}.yaml").read_text())
                continue
            for number in range(count):
                name = f"{recipe_id}--{number}"
                (place / f"{name}.yaml").write_text(recipe_text(entry, recipe_id, number, name))


def parts_on(side):
    split = yaml.safe_load((ROOT / "data/splits/full.yaml").read_text())
    sides = {name: parts for name, parts in split.items() if isinstance(parts, list)}
    if side not in sides:
        sys.exit(f"--side: expected one of {', '.join(sides)}")
    return set(sides[side])


def choose(command, files, draws, only):
    """`draws` with what the program chooses for the recipes of these families."""
    for families_file in files:
        with tempfile.TemporaryDirectory() as out:
            write_candidates([families_file], CANDIDATES.get(families_file.stem, 8), pathlib.Path(out), only)
            chosen = subprocess.run([command[0], out, *command[1:]], check=True, stdout=subprocess.PIPE, text=True).stdout
        draws.update(yaml.safe_load(chosen) or {})
    draws = {recipe_id: number for recipe_id, number in sorted(draws.items()) if number}
    DRAWS.write_text(DRAWS_HEADER + "".join(f"{i}: {number}\n" for i, number in draws.items()))
    return draws


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument("--redraw", action="store_true")
    mode.add_argument("--check", action="store_true")
    mode.add_argument("--candidates", type=int, metavar="N")
    mode.add_argument("--choose", metavar="PROGRAM", help="choose_recipes, as built")
    parser.add_argument("--category", help="only this one, such as window")
    parser.add_argument("--role", choices=("bodies", "handles"))
    parser.add_argument("--side", help="choose only for parts on this side of data/splits/full.yaml")
    parser.add_argument("--rounds", default="2", help="of --choose")
    parser.add_argument("--out", type=pathlib.Path, help="folder for the candidates")
    args = parser.parse_args()
    files = families_files(args.category, args.role)
    if args.candidates:
        if args.out is None:
            parser.error("--candidates needs --out")
        write_candidates(files, args.candidates, args.out)
        return 0
    draws = yaml.safe_load(DRAWS.read_text()) or {}
    if args.choose:
        draws = choose((args.choose, args.rounds), files, draws, parts_on(args.side) if args.side else None)
    problems = written = total = 0
    for families_file in files:
        for folder, recipe_id, entry in recipes(families_file):
            total += 1
            path = ROOT / "data/catalog" / folder / f"{recipe_id}.yaml"
            there = path.read_text() if path.exists() else None
            text = recipe_text(entry, recipe_id, draws.get(recipe_id, 0)) if entry else None
            if text is None or there == text:
                if there is None:
                    print(f"{path}: is to be written by hand", file=sys.stderr)
                    problems += 1
            elif args.check:
                print(f"{path}: {'missing' if there is None else 'differs from what is drawn'}", file=sys.stderr)
                problems += 1
            elif there is None or args.redraw or args.choose:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
                written += 1
    print(f"{total} recipes, {written} written, {problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

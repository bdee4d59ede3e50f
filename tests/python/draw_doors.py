# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Composes doors of the catalogue that are drawn at random, the same ones every time: every mechanism and both latches equally often,
every category that has the mechanism, hinged left and right, pulled and pushed.

    python3 draw_doors.py DOORFORGE OUT [COUNT]
"""
import collections
import pathlib
import random
import subprocess
import sys


def main() -> int:
    doorforge, out, count = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 60
    rows = [line.split() for line in subprocess.run([doorforge, "catalog", "list"], check=True, capture_output=True, text=True).stdout.splitlines()]
    bodies, handles = collections.defaultdict(list), collections.defaultdict(list)
    for part, role, category, mechanism, *_ in (row for row in rows if len(row) >= 4 and row[1] in ("body", "handle")):
        if role == "body":
            bodies[category].append(part)
        elif mechanism != "none":  # nothing turns: no latch
            handles[mechanism, category].append(part)
    mechanisms = sorted({mechanism for mechanism, _ in handles})
    draw = random.Random(29)
    made = refused = 0
    while made < count and refused < 10 * count:
        # which latch comes in turn for each mechanism
        mechanism, latch = mechanisms[made % len(mechanisms)], ("effort", "bolt")[made // len(mechanisms) % 2]
        category = draw.choice([found for other, found in handles if other == mechanism])
        settings = {"latch": latch, "hinge_side": draw.choice(["left", "right"])}
        if category in ("interior", "window"):
            settings["opening"] = draw.choice(["pull", "push"])
        body, handle = draw.choice(bodies[category]), draw.choice(handles[mechanism, category])
        folder = out / f"{made:02}_{mechanism}_{latch}"
        command = [doorforge, "compose", "--quiet", "--body", body, "--handle", handle, "--out", str(folder)]
        command += ["--set", f"id={folder.name}"]
        for name, value in settings.items():
            command += ["--set", f"{name}={value}"]
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode != 0:  # the two do not go together
            refused += 1
            continue
        made += 1
        print(folder.name, body, handle, *(f"{name}={value}" for name, value in settings.items()), flush=True)
    print(f"{made} doors of {len(mechanisms)} mechanisms; {refused} draws were refused", file=sys.stderr)
    return 0 if made == count else 1


if __name__ == "__main__":
    sys.exit(main())

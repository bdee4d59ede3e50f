# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the recipes of docs/latch-elsewhere.md in the simulators that they are for; not a part of ./test.sh.

    python tests/python/latch_judge.py docs/latch-elsewhere.md DOOR EXPORTED [--bolt BOLTED BOLTED_EXPORTED]

Needs pybullet, mujoco, sapien, newton and genesis-world, or those of them that `--only` names. Each recipe gives `angles()` and `step(push)`. The
opening is held against the hinge's own equation of motion, integrated here.
"""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

LOCKED_PUSH, HANDLE_PUSH, OPENING_PUSH = 75.0, 4.0, 10.0  # N m
STEPS = {"PyBullet": 1 / 240, "MuJoCo": 0.002, "SAPIEN and ManiSkill": 1 / 240, "Newton": 1 / 240, "Genesis": 1 / 240}

JUDGE = '''
import json, math
import numpy as np
{recipe}
at_most, count = 0.0, round(1 / {dt})
for _ in range(count):
    step(({locked}, 0.0))
    at_most = max(at_most, float(angles()[0]))
unlocked_at, time = None, 0.0
began = None
while time < 10 and float(angles()[0]) < math.pi / 4:
    step(({opening}, {handle} * min(time / 2, 1)))
    time += {dt}
    if began is None and float(angles()[0]) > math.radians(1):
        began, unlocked_at = time, float(angles()[1])
print("RESULT", json.dumps([math.degrees(at_most), None if began is None else math.degrees(unlocked_at),
                            None if began is None else time - began, float(angles()[0])]))
'''


def recipes(page: pathlib.Path) -> dict[str, str]:
    """The blocks that say `run`, by the heading before them."""
    return dict(re.findall(r"^## ([^\n]+)\n(?:(?!^## ).)*?^```python run\n(.*?)^```", page.read_text(), re.M | re.S))


def expected_s(exported: pathlib.Path, spring: float) -> float:
    """From 1 to 45 degrees, from rest at 0, by J a'' = push - friction - damping a' - spring a."""
    robot = ElementTree.parse(exported / "model.urdf").getroot()
    hinge = next(joint for joint in robot.iter("joint") if joint.get("name") == "hinge")
    dynamics = hinge.find("dynamics")
    damping, friction = (float(dynamics.get(key, 0)) for key in ("damping", "friction"))
    inertia = 0.0
    for link in robot.iter("link"):
        if link.get("name") == "base":
            continue
        own = link.find("inertial")
        mass = float(own.find("mass").get("value"))
        x, y, _ = (float(number) for number in own.find("origin").get("xyz").split())
        if link.get("name") != "leaf":  # its place in the leaf's frame, which is parallel
            joint = next(joint for joint in robot.iter("joint") if joint.find("child").get("link") == link.get("name"))
            dx, dy, _ = (float(number) for number in joint.find("origin").get("xyz").split())
            x, y = x + dx, y + dy
        inertia += float(own.find("inertia").get("izz")) + mass * (x * x + y * y)
    angle, speed, time, dt = 0.0, 0.0, 0.0, 1e-5
    while angle < math.pi / 4 and time < 10:
        speed += dt * (OPENING_PUSH - friction - damping * speed - spring * angle) / inertia
        angle += dt * speed
        time += dt if angle > math.radians(1) else 0
    return time


def without_visuals(path: pathlib.Path) -> None:
    tree = ElementTree.parse(path)
    for link in tree.getroot().iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    tree.write(path)


def run(name: str, recipe: str, door: pathlib.Path, exported: pathlib.Path) -> list:
    with tempfile.TemporaryDirectory() as scratch:
        os.symlink(door.resolve(), os.path.join(scratch, "door"))
        shutil.copytree(exported, os.path.join(scratch, "exported"))
        if name == "SAPIEN and ManiSkill":  # which reads no colours where there is no Vulkan
            without_visuals(pathlib.Path(scratch, "exported", "model.urdf"))
        program = JUDGE.format(recipe=recipe, dt=STEPS[name], locked=LOCKED_PUSH, opening=OPENING_PUSH, handle=HANDLE_PUSH)
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=scratch, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{name}: {done.stderr[-3000:]}")
    return json.loads(done.stdout.split("RESULT ")[1].splitlines()[0])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("door", type=pathlib.Path)
    parser.add_argument("exported", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", default=list(STEPS), choices=list(STEPS))
    parser.add_argument("--bolt", nargs=2, type=pathlib.Path, metavar=("DOOR", "EXPORTED"))
    options = parser.parse_args()
    doors = [("EffortLaw", options.door, options.exported)]
    if options.bolt:
        doors.append(("BoltLaw", *options.bolt))
    failed = False
    print("| simulator | law | held at 75 N m | lets go with the handle at | 1 to 45 degrees in | by the equation of motion |")
    print("|---|---|---|---|---|---|")
    for law, door, exported in doors:
        latch = json.loads((door / "door.json").read_text())["latch"]
        wanted = expected_s(exported, latch["hinge_spring_nm_per_rad"])
        unlock = math.degrees(latch["unlock_angle_rad"])
        for name, recipe in recipes(options.page).items():
            if name not in options.only:
                continue
            held, at, took, reached = run(name, recipe.replace("EffortLaw", law), door, exported)
            print(f"| {name} | {law} | {held:.2f} deg | {at or math.nan:.1f} deg of {unlock:.1f} | {took or math.nan:.2f} s | {wanted:.2f} s |",
                  flush=True)
            sound = held < 0.6 and at is not None and at > 0.85 * unlock and abs(took - wanted) < 0.15 * wanted
            failed = failed or not sound
    if failed:
        raise SystemExit("a latch did not hold, or a door did not open as it should")


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Doors of every category and latch, at the angles that a page's sliders reach, before urdf-loader; see urdf_loader_judge.sh.

usage: urdf_loader_judge.py BUILD JUDGE"""
import json
import pathlib
import sys
import tempfile

JUDGE = pathlib.Path(sys.argv.pop(2)).read_text()

import numpy as np  # noqa: E402

from browser import Browser  # noqa: E402
from pages import BUILD, run  # noqa: E402

MOST = 1e-6  # [m], and of the axes' numbers
SETTINGS = (("latch=effort", "hinge_side=left"), ("latch=bolt", "hinge_side=right"))
PUSHED = ("interior", "window")  # of which one passes or looks through


def first_parts() -> dict[str, dict[str, str]]:
    """A body and a handle of each category, and of each mechanism in it."""
    pairs: dict[str, dict[str, str]] = {}
    parts = json.loads(run("catalog", "list", "--json").stdout)["parts"]
    for handle in parts:
        if handle["role"] == "handle":
            body = next(part["id"] for part in parts if part["role"] == "body" and part["category"] == handle["category"])
            pairs.setdefault(f"{handle['category']}_{handle['mechanism']}", {"--body": body, "--handle": handle["id"]})
    return pairs


def main() -> int:
    with tempfile.TemporaryDirectory(dir=BUILD) as scratch, Browser() as browser:
        folder = pathlib.Path(scratch)
        worst, poses, moved, faults = 0.0, 0, 0.0, 0
        for name, parts in first_parts().items():
            for number, settings in enumerate(SETTINGS):
                if name.endswith("_none"):
                    settings = settings[1:]
                if number == 1 and name.startswith(PUSHED):
                    settings = (*settings, "opening=push")
                door = folder / f"{name}_{number}"
                run("compose", *(word for pair in parts.items() for word in pair), *(word for setting in settings for word in ("--set", setting)), "--out", door)
                run("view", door, "--out", folder / "page.html", "--overwrite")
                browser.open((folder / "page.html").as_uri())
                browser.js(JUDGE + ";0")
                text = (door / "model.urdf").read_text()
                for handle in np.linspace(0, 1.6, 5):
                    for hinge in np.linspace(0, 2, 5):
                        browser.js(f"doorforge.view.turnHandle(1.6), doorforge.view.moveHinge({hinge}), doorforge.view.turnHandle({handle}), 0")
                        latch = browser.js("({hinge: doorforge.view.latch.hinge, handle_joint: doorforge.view.latch.handle})")
                        shown = [np.array(pose) for pose in browser.js("doorforge.view.poses")]
                        angles = {joint: angle for joint, angle in latch.items() if f'name="{joint}"' in text}
                        judged = browser.js(f"posesByUrdfLoader({json.dumps(text)}, {json.dumps(angles)})")
                        for joint, angle in angles.items():  # none was beyond its limits; fixed ones have no angle
                            assert judged["angles"].get(joint, 0) == angle, (door.name, judged["angles"], angles)
                        for pose, link in zip(shown, ("base", "leaf", "handle")):
                            apart = float(np.abs(pose - np.array(judged["poses"][link])).max())
                            worst, poses = max(worst, apart), poses + 1
                            if apart > MOST:
                                faults += 1
                                print(f"{door.name}, {angles}: {link} is {apart:.1e} off")
                        moved = max(moved, float(np.abs(shown[2] - np.eye(4).ravel()).max()))
                print(f"{door.name}: looked at")
        assert moved > 0.5, "nothing was moved"
        print(f"{poses} poses, {worst:.1e} off at most")
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

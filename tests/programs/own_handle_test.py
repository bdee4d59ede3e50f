# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A user's own handle on a body of the catalogue, in one command."""
import json
import pathlib
import unittest
import xml.etree.ElementTree as ET

import numpy as np
from programs import ProgramTest, run

# An L lever: neck out of the door, bar along it. Points (out, along the door) in mm, and its triangles.
OUTLINE = [(0, -12.5), (50, -12.5), (50, -150), (68.75, -150), (68.75, 12.5), (0, 12.5)]
TRIANGLES = [(0, 1, 5), (1, 4, 5), (1, 2, 3), (1, 3, 4)]
HALF_HEIGHT = 11.25


def lever_facets(factor: float = 1) -> list:
    """Facets of the lever in a file's axes: x along the door, y up, z out of it."""

    def point(index: int, up: float) -> tuple:
        out, along = OUTLINE[index]
        return along * factor, up * factor, out * factor

    low, high = -HALF_HEIGHT, HALF_HEIGHT
    facets = []
    for a, b, c in TRIANGLES:
        facets.append([point(a, high), point(b, high), point(c, high)])
        facets.append([point(c, low), point(b, low), point(a, low)])
    for i in range(len(OUTLINE)):
        j = (i + 1) % len(OUTLINE)
        facets.append([point(i, low), point(j, low), point(j, high)])
        facets.append([point(i, low), point(j, high), point(i, high)])
    return facets


def write_stl(path: pathlib.Path, facets: list) -> None:
    lines = ["solid lever"]
    for facet in facets:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x} {y} {z}" for x, y, z in facet]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join(lines + ["endsolid lever", ""]))


def vertices_of(obj: pathlib.Path) -> np.ndarray:
    rows = [line.split()[1:4] for line in obj.read_text().splitlines() if line.startswith("v ")]
    return np.array(rows, dtype=float)


def joint_of(urdf: pathlib.Path, name: str) -> dict:
    joint = next(joint for joint in ET.parse(urdf).getroot().iter("joint") if joint.get("name") == name)
    numbers = {"axis": joint.find("axis").get("xyz"), "origin": joint.find("origin").get("xyz")}
    found = {key: np.array(text.split(), dtype=float) for key, text in numbers.items()}
    found["limits"] = (float(joint.find("limit").get("lower")), float(joint.find("limit").get("upper")))
    return found


class OwnHandle(ProgramTest):
    BODY = ("--body", "interior_flush_01")
    AXES = ("--handle-up", "y", "--handle-front", "z")

    def setUp(self) -> None:
        super().setUp()
        self.out = self.folder / "doors/mine"

    def compose(self, mesh: pathlib.Path, *more: str):
        return run("compose", *self.BODY, "--handle", mesh, "--handle-mechanism", "lever", *self.AXES, "--out",
                   self.out, *more)

    def assert_nothing_left(self) -> None:
        left = [path.name for path in self.folder.rglob("*") if path.is_dir() and path.name != "doors"]
        self.assertEqual(left, [])

    def test_one_command_makes_a_validated_pictured_door_that_opens(self):
        mesh = self.folder / "my_lever.stl"
        write_stl(mesh, lever_facets())
        result = self.compose(mesh, "--preview")
        self.assert_ends(result, 0)
        self.assertIn("read in mm", result.stderr)
        self.assertIn("validated: 0 errors", result.stdout)
        # in metres, as large as it was drawn
        grip = vertices_of(self.out / "meshes/visual/grip.obj")
        np.testing.assert_allclose(np.ptp(grip, axis=0), [0.06875, 0.1625, 0.0225], atol=2e-6)
        # it turns about its neck, out of the door, and lies on the leaf
        joint = joint_of(self.out / "model.urdf", "handle_joint")
        np.testing.assert_allclose(np.abs(joint["axis"]), [1, 0, 0], atol=1e-6)
        self.assertAlmostEqual(joint["limits"][1], np.pi / 4, places=6)
        neck = grip[grip[:, 0] < grip[:, 0].min() + 1e-5]
        np.testing.assert_allclose((neck.min(axis=0) + neck.max(axis=0))[1:] / 2, [0, 0], atol=1e-5)
        leaf = vertices_of(self.out / "meshes/visual/leaf.obj")
        self.assertAlmostEqual(joint["origin"][0] + grip[:, 0].min(), leaf[:, 0].max(), delta=0.002)
        # a picture, and not of nothing
        png = (self.out / "thumb.png").read_bytes()
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(png), 5000)
        counts = json.loads((self.out / "validation.json").read_text())["counts"]
        self.assertEqual(counts["errors"], 0)
        # the expert opens it
        self.assert_ends(run("simulate", "--door", self.out, "--seeds", "1"), 0)
        self.check_the_part_serves_again()
        self.assertEqual([path.name for path in self.out.parent.iterdir() if path.name.startswith(".")], [])

    def check_the_part_serves_again(self) -> None:
        other = self.folder / "doors/other"
        result = run("compose", "--body", "interior_flush_*", "--handle", self.out / "handle", "--out", other)
        self.assert_ends(result, 0)
        self.assertGreater(len(list(other.glob("*/door.json"))), 1)

    def test_what_is_not_known_is_asked_for_and_nothing_is_left(self):
        # 0.4 m in cm or 40 mm: both are handles
        ambiguous = self.folder / "ambiguous.stl"
        write_stl(ambiguous, lever_facets(40 / 162.5))
        result = self.compose(ambiguous)
        self.assert_refused(result, 2, 3)
        self.assertIn("--handle-unit", result.stderr)
        self.assert_nothing_left()
        giant = self.folder / "giant.stl"
        write_stl(giant, lever_facets(10))
        result = self.compose(giant)
        self.assert_refused(result, 2, 3)
        self.assertIn("--handle-size", result.stderr)
        self.assert_nothing_left()
        self.assert_refused(self.compose(self.folder / "missing.stl"), 3)
        self.assert_refused(self.compose(ambiguous, "--handle-unit", "yard"), 2, 3)
        (self.folder / "broken.stl").write_text("solid nothing")
        self.assert_refused(self.compose(self.folder / "broken.stl", "--handle-unit", "mm"), 2, 3)
        self.assert_nothing_left()

    def test_a_size_stands_for_the_unit(self):
        mesh = self.folder / "giant.stl"
        write_stl(mesh, lever_facets(10))
        self.assert_ends(self.compose(mesh, "--handle-size", "0.13"), 0)
        grip = vertices_of(self.out / "meshes/visual/grip.obj")
        self.assertAlmostEqual(np.ptp(grip, axis=0).max(), 0.13, places=5)


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What `doorforge import` keeps of an object: its masses, all of its doors, and of what this project exported the door itself.

usage: import_fidelity_test.py BUILD"""
import json
import pathlib
import unittest

import numpy as np

import foreign_samples as samples
from programs import ProgramTest, run

FORMATS = {"urdf": "model.urdf", "mjcf": "model.xml", "sdf": "model.sdf", "glb": "model.glb", "usda": "model.usda"}
DOORS = {
    "lever": ("interior_flush_01", "interior_lever_tube_01", ()),
    "bolt_right": ("interior_flush_01", "interior_lever_tube_01", ("latch=bolt", "hinge_side=right", "bolt_throw_m=0.015", "hinge_damping_nm_s=1.25")),
    "pushed": ("interior_flush_02", "interior_lever_tube_01", ("opening=push",)),
    "wheel": ("safe_antique_06", "safe_wheel_five_01", ("relatch=true", "lock_effort_nm=80", "unlock_angle_rad=0.7")),
    "flap": ("window_arched_01", "window_cockspur_03", ("unlocks_ajar=true", "opening=push", "hinge_side=right")),
    "pull": ("storage_bowed_rounded_01", "storage_pull_bow_01", ()),
}
BOX = '<geometry><box size="{}"/></geometry>'
LINK = '<link name="{name}"><visual><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></visual></link>'
JOINT = ('<joint name="{name}_joint" type="{type}"><parent link="{parent}"/><child link="{name}"/><origin xyz="{origin}"/><axis xyz="{axis}"/>'
         '<limit lower="0" upper="{upper}" effort="10" velocity="1"/></joint>')


def vertices(path: pathlib.Path) -> np.ndarray:
    return np.array([line.split()[1:4] for line in path.read_text().splitlines() if line.startswith("v ")], float)


def mass_of(mass: dict) -> np.ndarray:
    return np.array([mass["mass_kg"], *mass["center_of_mass_m"], *mass["inertia_xx_yy_zz_kg_m2"], *mass["inertia_xy_xz_yz_kg_m2"]])


def cabinet(name: str, height: float = 0.8) -> str:
    """Two doors, a drawer with a knob that turns, and a button that slides on the left door."""
    half = height / 2
    links = [("carcass", "0 0.5 %g" % half, "0.4 1 %g" % height), ("left_leaf", "0 0.2 0", "0.02 0.38 %g" % (0.6 * height)),
             ("right_leaf", "0 -0.2 0", "0.02 0.38 %g" % (0.6 * height)), ("tray", "0 0 0", "0.3 0.8 0.1"), ("tray_stud", "0.05 0 0", "0.03 0.03 0.03"),
             ("left_handle", "0.02 0 0", "0.03 0.02 0.12"), ("button", "0.02 0 0", "0.01 0.02 0.02")]
    joints = [("left_leaf", "revolute", "carcass", "0.22 0.05 %g" % (0.4 * height), "0 0 -1", 1.5), ("right_leaf", "revolute", "carcass", "0.22 0.95 %g" % (0.4 * height), "0 0 1", 1.5),
              ("tray", "prismatic", "carcass", "0.22 0.5 %g" % (0.85 * height), "1 0 0", 0.3), ("tray_stud", "revolute", "tray", "0.1 0 0", "1 0 0", 1),
              ("left_handle", "fixed", "left_leaf", "0 0.33 0", "1 0 0", 0), ("button", "prismatic", "left_leaf", "0 0.3 0.1", "1 0 0", 0.01)]
    return (f'<robot name="{name}">' + "".join(LINK.format(name=n, at=a, size=s) for n, a, s in links)
            + "".join(JOINT.format(name=n, type=t, parent=p, origin=o, axis=x, upper=u) for n, t, p, o, x, u in joints) + "</robot>")


class ImportFidelity(ProgramTest):
    def imported(self, *arguments: object, code: int = 0) -> list[dict]:
        out = self.folder / "parts"
        self.assert_ends(run("import", *arguments, "--out", out, "--overwrite"), code)
        return json.loads((out / "import.json").read_text())["objects"]

    def part(self, name: str) -> dict:
        return json.loads((self.folder / "parts" / name / "part.json").read_text())

    def mass(self, part: str, piece: str) -> np.ndarray:
        return mass_of(next(one["mass"] for one in self.part(part)["pieces"] if one["name"] == piece))

    def gate(self, text: str, name: str = "gate.urdf") -> pathlib.Path:
        for mesh, content in (("box.obj", samples.OBJ), ("box.stl", samples.STL)):
            path = self.folder / "meshes" / mesh
            path.parent.mkdir(exist_ok=True)
            path.write_text(content)
        (self.folder / name).write_text(text)
        return self.folder / name

    def test_exported_doors_come_back_from_every_format(self):
        worst = 0.0
        for name, (body, handle, settings) in DOORS.items():
            door = self.folder / "doors" / name
            self.assert_ends(run("compose", "--body", body, "--handle", handle, *(word for s in settings for word in ("--set", s)), "--out", door), 0)
            self.assert_ends(run("export", door, "--format", ",".join(FORMATS), "--out", self.folder / "exported" / name), 0)
            before = json.loads((door / "door.json").read_text())
            for kind, file in FORMATS.items():
                with self.subTest(door=name, format=kind):
                    folder = self.folder / f"{name}_{kind}"
                    model = next((self.folder / "exported" / name).glob(f"*/{file}"))
                    self.assert_ends(run("import", model, "--out", folder / "parts"), 0)
                    config = next((folder / "parts").glob("*/as_exported.json"))
                    self.assert_ends(run("compose", "--config", config, "--parts", folder / "parts", "--out", folder / "door"), 0)
                    worst = max(worst, self.assert_same_door(before, json.loads((folder / "door/door.json").read_text()), door, folder / "door"))
        print(f"{len(DOORS)} doors, {len(FORMATS)} formats: shapes differ by {worst:.2g} m at most")

    def assert_same_door(self, before: dict, after: dict, old: pathlib.Path, new: pathlib.Path) -> float:
        for key in ("id", "category", "mechanism", "latch", "hinge_side", "opening", "license"):
            self.assertEqual(before[key], after[key], key)
        for key in ("hinge", "handle_joint"):
            self.assertEqual(set(before[key]), set(after[key]))
            for name, value in before[key].items():
                if isinstance(value, (int, float, list)):
                    np.testing.assert_allclose(after[key][name], value, atol=1e-9, err_msg=f"{key} {name}")
            for name, value in before[key]["parent_from_child_at_zero"].items():
                np.testing.assert_allclose(after[key]["parent_from_child_at_zero"][name], value, atol=1e-9, err_msg=f"{key} {name}")
        worst = 0.0
        for one, two in zip(before["links"], after["links"]):
            np.testing.assert_allclose(mass_of(two["mass"]), mass_of(one["mass"]), atol=1e-6, err_msg=one["name"])
            points = [np.concatenate([vertices(folder / geometry["mesh"]["path"]) for geometry in link["geometry"]]) if link["geometry"] else np.zeros((1, 3))
                      for folder, link in ((old, one), (new, two))]
            for a, b in (points, points[::-1]):  # the corners of each lie on corners of the other
                for block in np.array_split(a, max(1, len(a) // 200)):
                    worst = max(worst, np.sqrt(((block[:, None] - b[None]) ** 2).sum(-1).min(1)).max())
        self.assertLess(worst, 1e-4)
        return worst

    def test_masses_of_sources_are_kept_and_said(self):
        entry, = self.imported(self.gate(samples.URDF))
        self.assertEqual(entry["category"], "interior")
        self.assertTrue(any("by the name" in note for note in entry["notes"]), entry["notes"])
        for piece in ("leaf", "grip"):
            self.assertIn(f"mass of {piece} is the source's", entry["notes"])
        # the leaf and what slides on it; in the part's frame the centre is found from the links' own places
        leaf = self.mass(entry["body"], "leaf")
        self.assertAlmostEqual(leaf[0], 20.2, places=9)
        grip = self.mass(entry["handle"], "grip")
        self.assertAlmostEqual(grip[0], 0.3, places=9)
        np.testing.assert_allclose(sorted(grip[4:7]), [0.0001, 0.0004, 0.0004], atol=1e-12)

    def test_every_format_keeps_the_same_mass(self):
        self.gate(samples.URDF)
        for name, text in (("gate.sdf", samples.SDF), ("gate.xml", samples.MJCF)):
            entry, = self.imported(self.gate(text, name))
            leaf = self.mass(entry["body"], "leaf")
            self.assertAlmostEqual(leaf[0], 20, places=9, msg=name)
            np.testing.assert_allclose(sorted(leaf[4:7]), [1.7, 6.5, 8], atol=1e-9, err_msg=name)

    def test_masses_that_cannot_be_meant_are_computed_and_that_is_said(self):
        for old, new, why in (('<mass value="20"/>', '<mass value="2e6"/>', "kg/m3"), ('ixx="8"', 'ixx="80"', "moments of inertia"),
                              ('<origin xyz="0 0.5 0"/>\n      <mass', '<origin xyz="0 9 0"/>\n      <mass', "outside"),
                              ('iyy="6.5"', 'iyy="0"', "moments of inertia")):
            self.assertIn(old, samples.URDF)
            entry, = self.imported(self.gate(samples.URDF.replace(old, new, 1)))
            told = [note for note in entry["notes"] if note.startswith("mass of leaf computed")]
            self.assertTrue(told and why in told[0], (why, entry["notes"]))
            self.assertNotAlmostEqual(self.mass(entry["body"], "leaf")[0], 20.2)

    def test_several_doors_share_their_frame_and_the_rest_is_named(self):
        path = self.folder / "thing.urdf"
        path.write_text(cabinet("kitchen_cabinet"))
        left, right = self.imported(path)
        for entry, other in ((left, right), (right, left)):
            self.assertEqual(entry["category"], "storagefurniture")
            notes = "\n".join(entry["notes"])
            self.assertIn('by the name "kitchen_cabinet"', notes)
            self.assertIn(f"shares its frame with {other['body']}", notes)
            self.assertIn("tray (tray) slides", notes)
            self.assertIn("tray_stud (tray_stud) turns on what stands still here", notes)
        self.assertIn("button (button) slides on the leaf", "\n".join(left["notes"]))
        self.assertTrue(left["handle"])
        # the frame of each holds carcass, drawer and the other leaf: 0.4 x 1 x 0.8 m and what stands before it
        for entry in (left, right):
            frame = next(one for one in self.part(entry["body"])["pieces"] if one["name"] == "frame")
            points = vertices(self.folder / "parts" / entry["body"] / frame["mesh"]["path"])
            np.testing.assert_allclose(sorted(np.ptp(points, axis=0))[2], 1, atol=1e-3)

    def test_a_category_that_no_name_tells_follows_from_the_height(self):
        for height, category in ((0.8, "storagefurniture"), (2.0, "interior")):
            path = self.folder / "thing.urdf"
            path.write_text(cabinet("thing", height))
            entries = self.imported(path)
            self.assertEqual({entry["category"] for entry in entries}, {category})
            self.assertIn(f"by its height of {height:g} m", "\n".join(entries[0]["notes"]))
        entries = self.imported(path, "--category", "safe")
        self.assertEqual({entry["category"] for entry in entries}, {"safe"})
        self.assertNotIn("assumed: category", "\n".join(entries[0]["notes"]))

    def test_usd_of_others_with_y_up_centimetres_and_scales(self):
        text = samples.USDA.replace("metersPerUnit = 1", "metersPerUnit = 0.01").replace('upAxis = "Z"', 'upAxis = "Y"')
        text = text.replace("(-0.02, 0, -1), (0.02, 0, -1), (0.02, 1, -1), (-0.02, 1, 1)", "(-2, -100, 0), (2, -100, 0), (2, -100, -100), (-2, 100, -100)")
        text = text.replace("(0, 0.5, 0)", "(0, 0, -50)").replace("(8, 6.5, 1.7)", "(80000, 17000, 65000)").replace('physics:axis = "Z"', 'physics:axis = "Y"')
        text = text.replace("double size = 0.2", "double size = 1\n            double3 xformOp:scale = (10, 200, 10)\n            uniform token[] xformOpOrder = [\"xformOp:scale\"]")
        path = self.folder / "gate.usda"
        path.write_text(text)
        entry, = self.imported(path)
        leaf = self.mass(entry["body"], "leaf")
        self.assertAlmostEqual(leaf[0], 20, places=9)
        np.testing.assert_allclose(sorted(leaf[4:7]), [1.7, 6.5, 8], atol=1e-9)
        frame = next(one for one in self.part(entry["body"])["pieces"] if one["name"] == "frame")
        points = vertices(self.folder / "parts" / entry["body"] / frame["mesh"]["path"])
        np.testing.assert_allclose(sorted(np.ptp(points, axis=0)), [0.1, 0.1, 2], atol=1e-6)

    def test_what_of_usd_and_gltf_is_not_read_is_refused_by_name(self):
        for old, new, why in (('def Xform "leaf" (', 'def Xform "leaf" (\n        prepend references = @other.usda@', "references"),
                              ('def PhysicsRevoluteJoint', 'def PhysicsSphericalJoint', "PhysicsSphericalJoint"),
                              ("rel physics:body1 = </gate/leaf>", "rel physics:body1 = </gate/lef>", "/gate/lef"),
                              ("faceVertexIndices = [0, 2,", "faceVertexIndices = [0, 9,", "faceVertexIndices")):
            self.assertIn(old, samples.USDA)
            path = self.folder / "gate.usda"
            path.write_text(samples.USDA.replace(old, new, 1))
            result = run("import", path, "--out", self.folder / "parts", "--overwrite")
            self.assert_refused(result, 1, 3)
            self.assertIn(why, result.stderr + result.stdout)


if __name__ == "__main__":
    unittest.main()

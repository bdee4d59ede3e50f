# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Profiles of targets: what `doorforge export --profile` writes keeps the rules of `doorforge validate --profile`, and each rule is found broken.

usage: target_profiles_test.py BUILD"""
import json
import pathlib
import struct
import unittest
import xml.etree.ElementTree

import foreign_samples as samples
from programs import ProgramTest, run

FILES = {"mujoco": "model.xml", "isaac": "model.usda", "gazebo": "model.sdf", "sapien": "model.urdf"}

# Target, what is written in place of what in the sound file, the rule that finds it.
BROKEN = [
    ("isaac", "    metersPerUnit = 1\n", "    metersPerUnit = 0.01\n", "PRF005"),
    ("isaac", 'upAxis = "Z"', 'upAxis = "Y"', "PRF005"),
    ("isaac", "defaultPrim = ", "comment = ", "PRF006"),
    ("isaac", '"PhysicsArticulationRootAPI", ', "", "PRF007"),
    ("isaac", 'token[] semantics:labels:class = ["leaf"]', "", "PRF008"),
    ("isaac", 'uniform token physics:approximation = "convexHull"', 'uniform token physics:approximation = "none"', "PRF009"),
    ("isaac", "float3[] extent = ", "float3[] other = ", "PRF010"),
    ("isaac", "float physics:mass = ", "float physics:density = ", "PRF002"),
    ("sapien", "<inertial>", "<inertials>", "PRF002"),
    ("gazebo", "<inertial>", "<!--", "PRF002"),
]


class TargetProfiles(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        door = self.folder / "door"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--set", "latch=bolt", "--out", door), 0)

    def export(self, target: str) -> pathlib.Path:
        out = self.folder / target
        self.assert_ends(run("export", self.folder / "door", "--profile", target, "--out", out, "--overwrite"), 0)
        return next(out.glob(f"*/{FILES[target]}"))

    def findings(self, path: pathlib.Path, target: str, code: int | tuple = 0) -> list[dict]:
        result = run("validate", path, "--profile", target, "--ask", "none", "--format", "json")
        self.assert_ends(result, *(code if isinstance(code, tuple) else (code,)))
        return json.loads(result.stdout)["findings"]

    def test_what_is_exported_for_a_target_keeps_its_rules(self):
        for target in FILES:
            with self.subTest(target=target):
                self.assertEqual(self.findings(self.export(target), target), [])

    def test_thumbnails_lie_where_catalogues_look(self):
        for target, place in (("isaac", ".thumbs/256x256/model.usda.png"), ("gazebo", "thumbnails/1.png")):
            model = self.export(target)
            for picture in (model.parent / place, model.parent / "thumbnail.png"):
                data = picture.read_bytes()
                self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
                self.assertEqual(struct.unpack(">II", data[16:24]), (256, 256))
            picture.unlink()
            (model.parent / place).unlink()
            self.assertEqual([f["code"] for f in self.findings(model, target)], ["PRF011"])
        out = self.folder / "plain"
        self.assert_ends(run("export", self.folder / "door", "--format", "glb", "--thumbnails", "--out", out), 0)
        self.assertTrue(list(out.glob("*/thumbnail.png")))
        self.assertEqual(run("export", self.folder / "door", "--out", self.folder / "none").returncode, 2)

    def test_each_rule_is_found_broken(self):
        for target, old, new, code in BROKEN:
            with self.subTest(code=code, target=target, new=new):
                model = self.export(target)
                text = model.read_text()
                self.assertIn(old, text)
                broken = text.replace(old, new)
                if "inertials" in new:
                    broken = broken.replace("</inertial>", "</inertials>")
                if new == "<!--":
                    broken = broken.replace("</inertial>", "-->")
                model.write_text(broken)
                self.assertIn(code, [f["code"] for f in self.findings(model, target, (0, 1))])

    def test_gazebo_wants_a_model_config_that_names_the_file(self):
        model = self.export("gazebo")
        config = model.parent / "model.config"
        config.write_text(config.read_text().replace("model.sdf", "other.sdf"))
        self.assertEqual([f["code"] for f in self.findings(model, "gazebo", 1)], ["PRF012"])
        config.unlink()
        self.assertEqual([f["code"] for f in self.findings(model, "gazebo", 1)], ["PRF012"])

    def test_formats_that_a_target_does_not_read_are_told(self):
        for target, other in (("mujoco", "gazebo"), ("isaac", "sapien"), ("gazebo", "sapien"), ("sapien", "mujoco")):
            self.assertIn("PRF001", [f["code"] for f in self.findings(self.export(other), target, 1)])

    def test_a_concave_collision_mesh_would_be_filled(self):
        # an L with arms of a width in a square of 2: with 1 its area is 3 of its hull's 3.5, with 0.25 it is 0.9375 of 2.469
        square = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
        points = [(x, y, z) for z in (0, 1) for x, y in square]
        sides = [f for i in range(6) for f in ((i, (i + 1) % 6, (i + 1) % 6 + 6), (i, (i + 1) % 6 + 6, i + 6))]
        caps = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
        faces = sides + [(c, b, a) for a, b, c in caps] + [(a + 6, b + 6, c + 6) for a, b, c in caps]

        def text(depth: float) -> str:
            moved = [(x * depth if x == 1 else x, y * depth if y == 1 else y, z) for x, y, z in points]
            return "".join("v {} {} {}\n".format(*p) for p in moved) + "".join("f {} {} {}\n".format(*(i + 1 for i in f)) for f in faces)
        (self.folder / "meshes").mkdir()
        for file in ("box.obj", "box.stl"):
            (self.folder / "meshes" / file).write_text(samples.OBJ if file == "box.obj" else samples.STL)
        path = self.folder / "gate.urdf"
        path.write_text(samples.URDF.replace("meshes/box.stl", "meshes/l.obj"))
        for depth, broken in ((1.0, False), (0.25, True)):
            (self.folder / "meshes/l.obj").write_text(text(depth))
            found = [f for f in self.findings(path, "sapien", (0, 1)) if f["code"] == "PRF013"]
            self.assertEqual(bool(found), broken, depth)

    def test_mesh_formats_of_targets(self):
        (self.folder / "meshes").mkdir()
        for file in ("box.off", "box.obj"):
            (self.folder / "meshes" / file).write_text(samples.OFF if file == "box.off" else samples.OBJ)
        path = self.folder / "gate.urdf"
        path.write_text(samples.URDF.replace("meshes/box.stl", "meshes/box.off"))
        self.assertIn("PRF004", [f["code"] for f in self.findings(path, "mujoco", 1)])
        self.assertIn("PRF004", [f["code"] for f in self.findings(path, "sapien", 1)])
        self.assertNotIn("PRF004", [f["code"] for f in self.findings(path, "physics", (0, 1))])

    def test_grasp_and_labels_are_in_every_format(self):
        out = self.folder / "all"
        self.assert_ends(run("export", self.folder / "door", "--format", "urdf,mjcf,sdf,glb,usda", "--out", out), 0)
        folder = next(out.iterdir())
        urdf = xml.etree.ElementTree.parse(folder / "model.urdf").getroot().find("doorforge")
        self.assertEqual(urdf.find("labels").attrib, {"base": "frame", "leaf": "leaf", "handle": "handle"})
        self.assertEqual(urdf.find("grasp").attrib["link"], "handle")
        mjcf = xml.etree.ElementTree.parse(folder / "model.xml").getroot()
        self.assertEqual({e.attrib["name"]: e.attrib["data"] for e in mjcf.iter("text") if e.attrib["name"].startswith("label_")},
                         {"label_base": "frame", "label_leaf": "leaf", "label_handle": "handle"})
        self.assertTrue([site for site in mjcf.iter("site") if site.attrib["name"] == "grasp"])
        data = (folder / "model.glb").read_bytes()
        document = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
        nodes = {node.get("name"): node for node in document["nodes"]}
        self.assertEqual([nodes[name]["extras"]["label"] for name in ("base", "leaf", "handle")], ["frame", "leaf", "handle"])
        self.assertIn(document["nodes"].index(nodes["grasp"]), nodes["handle"]["children"])
        record = json.loads((self.folder / "door/door.json").read_text())["handle_from_grasp"]
        self.assertEqual(nodes["grasp"]["translation"], record["position_m"])
        self.assertIn('def Xform "grasp"', (folder / "model.usda").read_text())


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Each kind of damage to a sound object is found by its rule at its line, alone, and sound objects have no finding."""
import collections
import json
import pathlib
import struct
import unittest

import foreign_samples as samples
from programs import ProgramTest, run

FILES = {"urdf": "model.urdf", "mjcf": "model.mjcf", "sdf": "model.sdf", "usda": "model.usda", "obj": "box.obj", "stl": "box.stl",
         "ply": "box.ply", "off": "box.off", "glb": "box.glb", "bstl": "box.stl", "gltf": "box.gltf"}
TEXTS = {"urdf": samples.URDF, "mjcf": samples.MJCF, "sdf": samples.SDF, "usda": samples.USDA, "obj": samples.OBJ,
         "stl": samples.STL, "ply": samples.PLY, "off": samples.OFF}

# Format, what is written in place of what (the first time that it stands there), the rule, and what stands on the line where
# it is found: by default what was written.
REPLACED = [
    ("urdf", '<robot name="gate">', '<robot name="gate"', "FIL002", "<material name"),
    ("urdf", "</robot>", "", "FIL002", None),
    ("urdf", '<link name="post">', '<link name="post" name="post">', "FIL002"),
    ("urdf", "</link>", "</lnk>", "FIL002"),
    ("urdf", 'rgba="0.6 0.4 0.2 1"', 'rgba="0.6 0.4 0.2 1', "FIL002"),
    ("urdf", 'name="gate"', 'name="g&ate"', "FIL002"),
    ("urdf", 'name="gate"', 'name="g\x01ate"', "FIL002"),
    ("urdf", '<?xml version="1.0"?>', '<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]>', "FIL004"),
    ("urdf", "<robot", "<mujoco", "FIL005", "<mujoco", ("</robot>", "</mujoco>")),
    ("urdf", '<mass value="20"/>', '<mass value="nan"/>', "FIL006"),
    ("urdf", '<mass value="20"/>', '<mass value="20 kg"/>', "FIL006"),
    ("urdf", 'xyz="0 0.05 0"', 'xyz="0 0.05"', "FIL006"),
    ("urdf", 'xyz="0 0.05 0"', 'xyz="0, 0.05, 0"', "FIL006"),
    ("urdf", 'upper="1.5"', 'upper="inf"', "FIL006"),
    ("urdf", 'rgba="0.6 0.4 0.2 1"', 'rgba="0.6 0.4 0.2"', "FIL006"),
    ("urdf", 'ixy="0"', "", "FIL007", '<inertia ixx="8"'),
    ("urdf", '<mass value="20"/>', "<mass/>", "FIL007"),
    ("urdf", '<mass value="20"/>', "", "FIL007", "<inertial>"),
    ("urdf", '<parent link="post"/>', "", "FIL007", '<joint name="hinge"'),
    ("urdf", '<link name="post">', "<link>", "FIL007", "<link>", ('<parent link="post"/>', "")),
    ("urdf", 'filename="meshes/box.obj"', "", "FIL007", '<mesh  scale'),
    ("urdf", '<geometry><sphere radius="0.03"/></geometry>', "", "FIL007", "<collision></collision>"),
    ("urdf", 'type="prismatic"', 'type="slider"', "FIL008"),
    ("urdf", '<sphere radius="0.03"/>', '<cone radius="0.03"/>', "FIL008"),
    ("urdf", '<visual><geometry><box size="0.02 0.1 0.02"/></geometry></visual>', "<visuals/>", "FIL009"),
    ("urdf", 'friction="0.1"', 'fricton="0.1"', "FIL009"),
    ("urdf", 'value="20"', 'value="${mass}"', "FIL010"),
    ("urdf", '<link name="post">', '<xacro:include filename="a.xacro"/><link name="post">', "FIL010"),
    ("urdf", '<link name="post">', '<link name="">', "TRE001", '<link name="">', ('<parent link="post"/>', '<parent link="leaf2"/>'),
     {"TRE004"}),
    ("urdf", '<link name="follower">', '<link name="lever">', "TRE002", '<link name="lever">§2', None, {"TRE004"}),
    ("urdf", '<joint name="slide"', '<joint name="turn"', "TRE003", '<joint name="turn"§2', None, {"TRE009"}),
    ("urdf", '<parent link="post"/>', '<parent link="pst"/>', "TRE004", '<joint name="hinge"'),
    ("urdf", '<child link="lever"/>', '<child link="leaf"/>', "TRE008", '<joint name="turn"', None, {"TRE007"}),
    ("urdf", '<child link="follower"/>', '<child link="lever"/>', "TRE005", '<joint name="slide"', None, {"TRE007"}),
    ("urdf", '<parent link="post"/>', '<parent link="lever"/>', "TRE006", '<joint name="hinge"'),
    ("urdf", "</robot>", '  <link name="alone"/>\n</robot>', "TRE007", '<link name="alone"/>'),
    ("urdf", 'mimic joint="turn"', 'mimic joint="trun"', "TRE009"),
    ("urdf", 'mimic joint="turn"', 'mimic joint="slide"', "TRE009"),
    ("urdf", '<material name="oak"/>', '<material name="ash"/>', "TRE013"),
    ("urdf", '<link name="post">', '<material name="oak"/>\n  <link name="post">', "TRE012", '<material name="oak"/>'),
    ("urdf", 'axis xyz="0 0 -1"', 'axis xyz="0 0 0"', "JNT001"),
    ("urdf", 'axis xyz="0 0 -1"', 'axis xyz="0 0 -2"', "JNT002"),
    ("urdf", '<limit lower="0" upper="1.5" effort="30" velocity="2"/>', "", "JNT003", '<joint name="hinge"'),
    ("urdf", 'lower="0" upper="1.5"', 'lower="1.5" upper="0"', "JNT004"),
    ("urdf", 'lower="0" upper="0.8"', 'lower="0.8" upper="0.8"', "JNT005"),
    ("urdf", 'effort="30"', "", "JNT006", 'upper="1.5"'),
    ("urdf", 'velocity="2"', "", "JNT006", 'upper="1.5"'),
    ("urdf", 'effort="30"', 'effort="-30"', "JNT007"),
    ("urdf", 'velocity="2"', 'velocity="0"', "JNT008"),
    ("urdf", 'upper="1.5"', 'upper="90"', "JNT009"),
    ("urdf", 'upper="0.02"', 'upper="20"', "JNT010"),
    ("urdf", 'damping="0.1"', 'damping="-0.1"', "JNT011"),
    ("urdf", 'xyz="0 0.05 0"', 'xyz="0 500 0"', "JNT012", '<joint name="hinge"', None, {"GEO014"}),
    ("urdf", 'multiplier="0.02"', 'multiplier="0"', "JNT013"),
    ("urdf", 'mass value="20"', 'mass value="-20"', "INR001"),
    ("urdf", 'mass value="20"', 'mass value="0"', "INR001"),
    ("urdf", 'ixx="8"', 'ixx="-8"', "INR002"),
    ("urdf", 'ixy="0" ixz="0" iyy="6.5"', 'ixy="9" ixz="0" iyy="6.5"', "INR002"),
    ("urdf", 'ixx="8"', 'ixx="80"', "INR003"),
    ("urdf", 'mass value="20"', 'mass value="20000"', "INR007"),
    ("urdf", '<origin xyz="0 0.5 0"/>', '<origin xyz="0 500 0"/>', "INR008", "<inertial>"),
    ("urdf", 'ixx="8" ixy="0" ixz="0" iyy="6.5" iyz="0" izz="1.7"',
     'ixx="8e6" ixy="0" ixz="0" iyy="6.5e6" iyz="0" izz="1.7e6"', "INR009"),
    ("urdf", "meshes/box.obj", "meshes/bax.obj", "GEO001"),
    ("urdf", "meshes/box.obj", "../../box.obj", "GEO002"),
    ("urdf", "meshes/box.obj", "/etc/passwd", "GEO002"),
    ("urdf", "meshes/box.obj", "file:///etc/passwd", "GEO002"),
    ("urdf", "meshes/box.obj", "https://example.org/box.obj", "GEO002"),
    ("urdf", "meshes/box.obj", "package://gates/meshes/box.obj", "GEO003"),
    ("urdf", "meshes/box.obj", "package.xml", "GEO004"),
    ("urdf", "meshes/box.obj", "meshes/broken.obj", "GEO005"),
    ("urdf", 'scale="0.04 1 2"', 'scale="0 1 2"', "GEO006"),
    ("urdf", 'scale="0.04 1 2"', 'scale="-0.04 1 2"', "GEO007"),
    ("urdf", 'scale="0.04 1 2"', 'scale="40 1000 2000"', "GEO008", None, None, {"INR007"}),
    ("urdf", "meshes/box.stl", "meshes/open.obj", "GEO009"),
    ("urdf", "meshes/box.stl", "meshes/turned.obj", "GEO010"),
    ("urdf", "meshes/box.stl", "meshes/inside_out.obj", "GEO013"),
    ("urdf", '<box size="0.06 0.12 0.02"/>', '<box size="0.06 0 0.02"/>', "GEO015"),
    ("urdf", '<sphere radius="0.03"/>', '<sphere radius="-0.03"/>', "GEO015"),
    ("urdf", "meshes/box.obj", "meshes/without_material.obj", "GEO016", "mtllib@without_material.obj"),
    ("urdf", 'lower="0" upper="1.5"', 'lower="0.5" upper="1.5"', "MEC002"),
    ("urdf", 'upper="1.5"', 'upper="0.5"', "MEC003"),
    ("urdf", '<origin xyz="0.05 0.9 0"/>', '<origin xyz="0.05 1.9 0"/>', "HND003", '<link name="lever">'),
    ("urdf", '<origin xyz="0.05 0.9 0"/>', '<origin xyz="0.25 0.9 0"/>', "HND009", '<link name="lever">'),
    ("urdf", '<origin xyz="0 0.05 0"/>', '<origin xyz="0 0.05 0"/>', "MEC009", '<joint name="hinge"',
     ('<origin xyz="0 0.5 0"/>\n      <geometry><mesh filename="meshes/box.obj" scale="0.04 1 2"/></geometry>\n    </visual>\n'
      '    <collision>\n      <origin xyz="0 0.5 0"/>',
      '<origin xyz="0 0.8 0"/>\n      <geometry><mesh filename="meshes/box.obj" scale="0.04 1 2"/></geometry>\n    </visual>\n'
      '    <collision>\n      <origin xyz="0 0.8 0"/>')),

    ("mjcf", "</mujoco>", "", "FIL002", None),
    ("mjcf", 'axis="0 0 -1"', 'axis="0 0 x"', "FIL006"),
    ("mjcf", 'mass="20"', "", "FIL007", "<inertial"),
    ("mjcf", ' size="0.05 0.05 1"', "", "FIL007", 'name="post"'),
    ("mjcf", 'type="capsule"', 'type="pill"', "FIL008"),
    ("mjcf", 'name="hinge" type="hinge"', 'name="hinge" type="revolute"', "FIL008"),
    ("mjcf", 'name="turn" type="hinge"', 'name="hinge" type="hinge"', "TRE003", 'axis="1 0 0"', ('joint="turn"', 'joint="hinge"')),
    ("mjcf", 'mesh="leaf"', 'mesh="leef"', "TRE011"),
    ("mjcf", 'class="metal" type', 'class="steel" type', "TRE011"),
    ("mjcf", 'motor joint="turn"', 'motor joint="trun"', "TRE011"),
    ("mjcf", 'material="oak"', 'material="ash"', "TRE011"),
    ("mjcf", 'name="grip"', 'name="panel"', "TRE012", 'name="panel"§2'),
    ("mjcf", 'axis="0 0 -1"', 'axis="0 0 0"', "JNT001"),
    ("mjcf", 'range="0 1.5"', 'range="1.5 0"', "JNT004"),
    ("mjcf", 'damping="0.1"', 'damping="-0.1"', "JNT011", None),
    ("mjcf", 'mass="20"', 'mass="-20"', "INR001"),
    ("mjcf", 'diaginertia="8 6.5 1.7"', 'diaginertia="80 6.5 1.7"', "INR003"),
    ("mjcf", 'file="box.obj"', 'file="bax.obj"', "GEO001"),
    ("mjcf", 'size="0.05 0.05 1"', 'size="0.05 -0.05 1"', "GEO015"),
    ("sdf", '<joint name="anchor"', '<joint name="__anchor__"', "EXT004", None),
    ("mjcf", 'solref=""', "", "EXT002", None, ('<geom name="post"', '<geom smell="x" name="post"')),

    ("sdf", "</sdf>", "", "FIL002", None),
    ("sdf", "<mass>20</mass>", "<mass>heavy</mass>", "FIL006"),
    ("sdf", "<pose>0 0.05 0 0 0 0</pose>", "<pose>0 0.05 0</pose>", "FIL006"),
    ("sdf", "<parent>post</parent>", "", "FIL007", 'name="hinge"'),
    ("sdf", 'type="revolute"', 'type="hinge"', "FIL008"),
    ("sdf", "<dynamics>", "<dinamics>", "FIL009", None, ("</dynamics>", "</dinamics>")),
    ("sdf", '<link name="leaf">', '<link name="post">', "TRE002", '<link name="post">§2', None, {"TRE004"}),
    ("sdf", "<child>leaf</child>", "<child>leef</child>", "TRE004", 'name="hinge"'),
    ("sdf", "<xyz>0 0 -1</xyz>", "<xyz>0 0 0</xyz>", "JNT001"),
    ("sdf", "<upper>1.5</upper>", "<upper>-1.5</upper>", "JNT004"),
    ("sdf", "<izz>1.7</izz>", "<izz>17</izz>", "INR003"),
    ("sdf", "<mass>20</mass>", "<mass>-1</mass>", "INR001"),
    ("sdf", "meshes/box.stl", "meshes/bax.stl", "GEO001"),
    ("sdf", "meshes/box.stl", "model://fence/box.stl", "GEO003"),
    ("sdf", "<size>0.1 0.1 2</size>", "<size>0.1 0 2</size>", "GEO015", "<size>"),

    ("usda", "#usda 1.0", "#usd 1.0", "FIL005", None),
    ("usda", '        double size = 0.2\n        }', '        double size = 0.2\n', "FIL002", None),
    ("usda", "size = 0.2", "size = ", "FIL002", "size = §+1"),
    ("usda", 'axis = "Z"', 'axis = "W"', "FIL008"),
    ("usda", "physics:mass = 20", "physics:mass = -20", "INR001"),
    ("usda", "(8, 6.5, 1.7)", "(80, 6.5, 1.7)", "INR003"),
    ("usda", "</gate/leaf>", "</gate/leef>", "USD001", None, None, None),
    ("usda", "metersPerUnit = 1", "", "USD002", "#usda", None, "any"),
    ("usda", "0, 3, 2]", "0, 3, 9]", "USD003"),
    ("usda", "[3, 3, 3, 3]", "[3, 3, 3, 4]", "USD003", "faceVertexIndices"),
    ("usda", "upperLimit = 85", "upperLimit = -85", "JNT004", "lowerLimit"),

    ("obj", "f 1 2 4", "f 1 2 99", "GEO005"),
    ("obj", "v -0.5 -0.5 -0.5", "v -0.5 nan -0.5", "GEO005"),
    ("obj", "v -0.5 -0.5 -0.5", "v -0.5 -0.5", "GEO005"),
    ("obj", "f 1 2 4", "f 1 2", "GEO005"),
    ("obj", "f 1 2 4\n", "", "GEO009", None),
    ("obj", "f 1 2 4", "f 1 4 2", "GEO010", None),
    ("obj", "f 1 2 4", "f 1 2 4\nf 1 1 2", "GEO011", None),
    ("obj", "f 1 2 4", "f 1 2 4\nf 2 4 1", "GEO012", None),
    ("obj", "f 1 2 4", "f 1 2 4\nv 3 3 3\nf 1 2 9", "GEO017", None, None, {"GEO009", "GEO010"}),
    ("obj", "# a box", "mtllib none.mtl\n# a box", "GEO016", "mtllib none"),
    ("stl", "endsolid box", "", "GEO005", None),
    ("stl", "vertex -0.5 -0.5 -0.5", "vertex -0.5 -0.5 -0.x", "GEO005"),
    ("stl", "vertex -0.5 -0.5 -0.5\n", "\n", "GEO005", "endloop"),
    ("ply", "element vertex 8", "element vertex 800000000", "GEO005", "end_header"),
    ("ply", "3 0 1 3", "3 0 1 33", "GEO005"),
    ("ply", "format ascii", "format ascci", "GEO005", "end_header"),
    ("ply", "property float x", "property flout x", "GEO005"),
    ("off", "8 12 18", "8 120000000 18", "GEO005"),
    ("off", "3 0 1 3", "3 0 1 -3", "GEO005"),
    ("off", "OFF", "FOF", "GEO005"),
]


def broken_glb() -> list[tuple[str, bytes, str]]:
    """Name, bytes and rule of damaged GLB files."""
    document, binary = samples.gltf_box()

    def changed(edit) -> bytes:
        copy = json.loads(json.dumps(document))
        edit(copy)
        return samples.glb(copy, binary)

    sound = samples.glb(document, binary)
    nan = struct.pack("<f", float("nan"))
    return [
        ("cut", sound[:-20], "GLB001"),
        ("length", sound[:8] + struct.pack("<I", 7) + sound[12:], "GLB001"),
        ("version", sound[:4] + struct.pack("<I", 1) + sound[8:], "GLB001"),
        ("chunk", sound[:12] + struct.pack("<I", 1 << 31) + sound[16:], "GLB001"),
        ("json", sound.replace(b'"asset":', b'"asset" ', 1), "FIL002"),
        ("asset", changed(lambda d: d["asset"].clear()), "FIL007"),
        ("mesh_index", changed(lambda d: d["nodes"][1].update(mesh=7)), "GLB002"),
        ("view_index", changed(lambda d: d["accessors"][0].update(bufferView=9)), "GLB002"),
        ("material", changed(lambda d: d["meshes"][0]["primitives"][0].update(material=3)), "GLB002"),
        ("count", changed(lambda d: d["accessors"][1].update(count=360000)), "GLB003"),
        ("view", changed(lambda d: d["bufferViews"][1].update(byteLength=7200)), "GLB003"),
        ("buffer", changed(lambda d: d["buffers"][0].update(byteLength=1 << 30)), "GLB003"),
        # their product is 2^64, which is 0 in 64 bits
        ("stride", changed(lambda d: (d["bufferViews"][d["accessors"][0]["bufferView"]].update(byteStride=1 << 36),
                                      d["accessors"][0].update(count=(1 << 28) + 1))), "GLB003"),
        ("bounds", changed(lambda d: d["accessors"][0].update(max=[0.1] * 3)), "GLB004"),
        ("nan", samples.glb(document, nan + binary[4:]), "GLB004"),
        ("index", samples.glb(document, binary[:96] + struct.pack("<H", 60000) + binary[98:]), "GLB005"),
        ("loop", changed(lambda d: d["nodes"][1].update(children=[0])), "GLB006"),
        ("scale", changed(lambda d: d["nodes"][1].update(scale=[1, 0, 1])), "GLB007"),
        ("component", changed(lambda d: d["accessors"][0].update(componentType=5555)), "FIL008"),
    ]


def line_of(text: str, mark: str | None, written: str) -> int | None:
    """The line that `mark` stands on: "part§2" its second time, "part§last" its last, "part§+1" the line after it."""
    if mark is None:
        return None
    part, _, which = mark.partition("§")
    lines = [number for number, line in enumerate(text.splitlines(), 1) if (part or written) in line]
    if not lines:
        raise AssertionError(f"no line holds {part or written!r}")
    return lines[-1] if which == "last" else lines[0] + 1 if which == "+1" else lines[int(which or 1) - 1]


class ForeignDamage(ProgramTest):
    def place(self, name: str, file: str, content: str | bytes) -> pathlib.Path:
        folder = self.folder / name
        (folder / "meshes").mkdir(parents=True)
        (folder / "package.xml").write_text("<package/>")  # what its paths may not leave
        faces = samples.OBJ[samples.OBJ.index("\nf ") + 1:].splitlines()
        vertices = samples.OBJ[:samples.OBJ.index("\nf ") + 1]
        inside_out = ["f " + " ".join(reversed(face.split()[1:])) for face in faces]
        meshes = {"box.obj": samples.OBJ, "box.stl": samples.STL, "broken.obj": "v 0 0 0\nf 1 2 3\n",
                  "open.obj": vertices + "\n".join(faces[1:]) + "\n", "turned.obj": vertices + "\n".join(inside_out[:1] + faces[1:]) + "\n",
                  "inside_out.obj": vertices + "\n".join(inside_out) + "\n",
                  "without_material.obj": "mtllib none.mtl\n" + samples.OBJ}
        for mesh, text in meshes.items():
            (folder / "meshes" / mesh).write_text(text)
        path = folder / file
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def validate(self, paths: list[pathlib.Path]) -> dict[str, dict]:
        result = run("validate", *paths, "--format", "json")
        self.assert_ends(result, 0, 1)
        report = json.loads(result.stdout)
        return {item["path"]: item for item in report["items"]}

    def test_sound_objects_have_no_finding(self):
        document, binary = samples.gltf_box()
        paths = [self.place(name, FILES[name], text) for name, text in TEXTS.items()]
        paths.append(self.place("bstl", "box.stl", samples.BINARY_STL))
        paths.append(self.place("glb", "box.glb", samples.glb(document, binary)))
        for path, item in self.validate(paths).items():
            self.assertEqual(item["findings"], [], path)
            self.assertFalse([note for note in item["notes"] if "refuses" in note], path)

    def test_exported_doors_have_no_finding(self):
        doors = self.folder / "doors"
        for body, handle in (("interior_flush_01", "interior_lever_tube_01"), ("window_arched_01", "window_cockspur_03"),
                             ("safe_antique_06", "safe_wheel_five_01"), ("storage_bowed_rounded_01", "storage_pull_bow_01")):
            self.assert_ends(run("compose", "--body", body, "--handle", handle, "--out", doors / body), 0)
        self.assert_ends(run("export", doors, "--format", "urdf,mjcf,sdf,glb,usda", "--out", self.folder / "exported"), 0)
        models = sorted((self.folder / "exported").glob("*/model.*"))
        models = [path for path in models if path.suffix != ".config"]
        self.assertEqual(len(models), 20)
        for path, item in self.validate(models).items():
            self.assertEqual(item["findings"], [], path)

    def test_each_damage_is_found_by_its_rule_at_its_line(self):
        cases = []
        for number, (kind, old, new, code, *more) in enumerate(REPLACED):
            mark, also, others = ([*more, None, None, None] if more else [new, None, None])[:3]
            text = TEXTS[kind]
            if code != "EXT002":
                self.assertIn(old, text, f"damage {number} of {kind}")
            text = text.replace(old, new, 1)
            if also:
                self.assertIn(also[0], text, f"damage {number} of {kind}")
                text = text.replace(also[0], also[1], 1)
            path = self.place(f"{number:03}_{code}", FILES[kind], text)
            line = None if mark and "@" in mark else line_of(text, mark, new)
            cases.append((path, code, line, others or set(), f"{kind}: {old!r} -> {new!r}"))
        for name, content, code in broken_glb():
            cases.append((self.place(f"glb_{name}", "box.glb", content), code, None, set(), f"glb: {name}"))
        cut = self.place("cut_stl", "box.stl", samples.BINARY_STL[:-30])
        cases.append((cut, "GEO005", None, set(), "binary STL, cut"))
        empty = self.place("empty", "model.urdf", "")
        cases.append((empty, "FIL001", None, set(), "an empty file"))
        crate = self.place("crate", "model.usdc", b"PXR-USDC" + bytes(100))
        cases.append((crate, "FIL011", None, set(), "binary USD"))
        items = self.validate([case[0] for case in cases])
        faults = []
        for path, code, line, others, what in cases:
            findings = items[str(path)]["findings"]
            codes = collections.Counter(finding["code"] for finding in findings)
            lines = {finding.get("line") for finding in findings if finding["code"] == code}
            if code not in codes:
                faults.append(f"{what}: not found by {code}, but {dict(codes)}")
            elif others != "any" and set(codes) - {code} - others:
                faults.append(f"{what}: {code} and also {[f['code'] + ' ' + f['measured'] for f in findings]}")
            elif line is not None and line not in lines:
                faults.append(f"{what}: {code} at line {lines}, expected {line}")
        self.assertEqual(faults, [], "\n" + "\n".join(faults))
        self.assertGreaterEqual(len(cases), 100)
        print(f"{len(cases)} kinds of damage, {len({case[1] for case in cases})} rules")

    def test_bombs_are_refused_within_limits(self):
        joints = "".join(f'<joint name="j{i}" type="fixed"><parent link="a"/><child link="b{i}"/></joint>' for i in range(60000))
        bombs = {
            "deep.urdf": ("<a>" * 100000, "FIL003"),
            "joints.urdf": (f'<robot name="r"><link name="a"/>{joints}</robot>', "FIL003"),
            "attributes.urdf": ("<robot " + " ".join(f'a{i}="1"' for i in range(1000)) + "/>", "FIL003"),
            "large.urdf": ("<robot>" + " " * (17 << 20) + "</robot>", "FIL003"),
            "entities.sdf": ('<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa">]><sdf>&a;</sdf>', "FIL004"),
            "deep.usda": ("#usda 1.0\n" + 'def "a" {\n' * 10000, "FIL003"),
            "values.usda": ('#usda 1.0\ndef "a" {\nint[] b = ' + "[" * 100000, "FIL003"),
            "deep.gltf": ("[" * 100000, "FIL002"),
        }
        paths = [self.place(name, name, text) for name, (text, _) in bombs.items()]
        result = run("validate", *paths, "--format", "json", "--ask", "none", memory_gib=4, timeout=60)
        self.assert_ends(result, 1)
        items = {item["path"]: item for item in json.loads(result.stdout)["items"]}
        for path, (name, (_, code)) in zip(paths, bombs.items()):
            self.assertIn(code, [finding["code"] for finding in items[str(path)]["findings"]], name)


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Small files that ask for much: entities, nesting, sizes that lie, a million of anything; for each format that is read."""
import json
import struct

import foreign_samples as samples

MILLION = 1_000_000

LAUGHS = "<!DOCTYPE {root} [<!ENTITY a0 \"ha\">" + "".join(
    f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 12)) + "]>"
OUTSIDE = '<!DOCTYPE {root} [<!ENTITY a11 SYSTEM "file:///dev/zero">]>'
PARAMETER = '<!DOCTYPE {root} [<!ENTITY % a SYSTEM "file:///etc/passwd"> %a;]>'

XML = {"urdf": ("robot", samples.URDF, 'name="gate"'), "mjcf": ("mujoco", samples.MJCF, 'model="gate"'),
       "sdf": ("sdf", samples.SDF, 'name="gate"')}


def xml_bombs(kind: str) -> dict[str, tuple[str, str]]:
    """What stands in the file, and the rule that names it."""
    root, sound, name = XML[kind]
    body = sound[sound.index("<" + root):]
    named = body.replace(name, name.replace("gate", "&a11;"), 1)
    begin, end = body[:body.index(">", body.index("<" + root)) + 1], f"</{root}>"
    inside = {"urdf": "", "mjcf": "<worldbody>", "sdf": '<model name="m">'}[kind]
    outside = {"urdf": "", "mjcf": "</worldbody>", "sdf": "</model>"}[kind]
    link = {"urdf": '<link name="l{0}"/>', "mjcf": '<body name="l{0}"/>', "sdf": '<link name="l{0}"/>'}[kind]
    joint = {"urdf": '<joint name="j{0}" type="fixed"><parent link="a"/><child link="l{0}"/></joint>',
             "mjcf": '<body><joint name="j{0}"/></body>',
             "sdf": '<joint name="j{0}" type="fixed"><parent>a</parent><child>l{0}</child></joint>'}[kind]

    def many(what: str, count: int) -> str:
        return begin + inside + "".join(map(what.format, range(count))) + outside + end

    return {
        "laughs": (LAUGHS.format(root=root) + named, "FIL004"),
        "outside_entity": (OUTSIDE.format(root=root) + named, "FIL004"),
        "parameter_entity": (PARAMETER.format(root=root) + named, "FIL004"),
        "late_entity": (named.replace(end, '<!ENTITY a11 "ha">' + end), "FIL002"),
        "nested": (begin + "<a>" * MILLION + "</a>" * MILLION + end, "FIL003"),
        "nested_bodies": (begin + inside + '<body name="b">' * MILLION, "FIL003"),
        "million_links": (many(link, MILLION // 2), "FIL003"),
        "many_joints": (many(joint, 150_000), "FIL003"),
        "two_thousand_joints": (many(joint, 2_001), "FIL003"),
        "attributes": (begin.replace(">", "".join(f' a{i}="1"' for i in range(MILLION)) + ">") + end, "FIL003"),
        "long_name": (body.replace(name, name.replace("gate", "g" * (8 << 20)), 1), "FIL003"),
        "comments": (begin + "<!---->" * (2 * MILLION) + "<a", "FIL002"),
        "text": (begin + "a&amp;" * (2 * MILLION) + "<a", "FIL002"),
        "too_large": (begin + " " * (17 << 20) + end, "FIL003"),
        "utf16": (body.encode("utf-16"), "FIL002"),
        "zeros": (bytes(1 << 20), "FIL002"),
    }


def mjcf_bombs() -> dict[str, tuple[str, str]]:
    begin = '<mujoco model="gate">'

    def world(content: str) -> str:
        return samples.MJCF.replace("<worldbody>", "<worldbody>" + content, 1)

    classes = "".join(f'<default class="c{i}"/>' for i in range(30_000))
    numbers = "".join(f'<geom a{i}="1"/>' for i in range(30_000))
    deep = "".join(f'<default class="d{i}">' + "".join(f'<e{i}x{k} a="1"/>' for k in range(3_000)) for i in range(50))
    return {
        "classes": (f'{begin}<default><default class="a">{numbers}{classes}</default></default></mujoco>', None),
        "deep_classes": (f"{begin}<default>{deep}{'</default>' * 50}</default></mujoco>", None),
        "replicate": (world('<replicate count="1000000000"><body><freejoint/><geom size="1"/></body></replicate>'), "EXT002"),
        "composite": (world('<body><composite type="grid" count="100000 100000 1" spacing="1"><geom size="0.1"/></composite></body>'), "EXT002"),
        "flexcomp": (world('<body><flexcomp name="f" type="grid" count="9999 9999 9999" spacing="1 1 1"/></body>'), "EXT002"),
        "field": (samples.MJCF.replace("<asset>", '<asset><hfield name="h" nrow="2000000000" ncol="2000000000" size="1 1 1 1"/>', 1), "EXT002"),
        "texture": (samples.MJCF.replace(
            "<asset>", '<asset><texture name="t" type="2d" builtin="flat" width="2000000000" height="2000000000"/>', 1), "EXT002"),
        "stack": (samples.MJCF.replace("<compiler", '<size memory="1000G" njmax="2000000000"/><compiler', 1), "EXT002"),
        "key": (samples.MJCF.replace("</mujoco>", f'<keyframe><key qpos="{"1 " * (2 * MILLION)}"/></keyframe></mujoco>'), "EXT002"),
        "itself": (samples.MJCF.replace("<compiler", '<include file="model.mjcf"/><compiler', 1), None),
    }


def sdf_bombs() -> dict[str, tuple[str, str]]:
    model = '<model name="m"><include><uri>model.sdf</uri></include></model>'
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    crowd = ('<population name="p"><model_count>1000000000</model_count><distribution><type>random</type></distribution>'
             f'<model name="m"><link name="a"><collision name="c">{box}</collision></link></model></population>')
    frames = "".join(f'<frame name="f{i}" attached_to="f{(i + 1) % 9999}"/>' for i in range(9999))
    return {
        "itself": (f'<sdf version="1.7">{model}</sdf>', None),
        "crowd": (f'<sdf version="1.7"><world name="w">{crowd}</world></sdf>', None),
        "frames": (f'<sdf version="1.7"><model name="m"><link name="a"/>{frames}</model></sdf>', "FIL003"),
        "models": ('<sdf version="1.7">' + "".join(f'<model name="m{i}">' for i in range(60)) + '<link name="a"/>'
                   + "</model>" * 60 + "</sdf>", None),
    }


def usda_bombs() -> dict[str, tuple[str, str]]:
    begin = samples.USDA[:samples.USDA.index("def Xform")]

    def mesh(points: str, counts: str, indices: str) -> str:
        return (f'{begin}def Mesh "m" {{\npoint3f[] points = {points}\nint[] faceVertexCounts = {counts}\n'
                f"int[] faceVertexIndices = {indices}\n}}\n")

    triangle = "[(0, 0, 0), (1, 0, 0), (0, 1, 0)]"
    long_name = "n" * (4 << 20)
    bodies = "".join(f'def Xform "b{i}" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {{}}\n' for i in range(2_001))
    return {
        "nested": (begin + 'def "a" {\n' * MILLION, "FIL003"),
        "tuples": (begin + 'def "a" {\nint[] b = ' + "(" * MILLION, "FIL003"),
        "lists": (begin + 'def "a" {\nint[] b = ' + "[" * MILLION + "]" * MILLION + "}", "FIL003"),
        "metadata": ("#usda 1.0\n(\ncustomLayerData = " + "{ dictionary a = " * MILLION, "FIL003"),
        "million_prims": (begin + "".join(f'def "a{i}" {{}}\n' for i in range(900_000)), "FIL003"),
        "bodies": (begin + bodies, "FIL003"),
        "million_properties": (begin + 'def "a" {\n' + "".join(f"int a{i} = 1\n" for i in range(800_000)) + "}\n", None),
        "long_path": (begin + f'def "{long_name}" {{\n' + "".join(f'def "a{i}" {{}}\n' for i in range(100_000)) + "}\n", "FIL003"),
        "many_numbers": (mesh("[" + "(1,1,1)," * 2_000_000 + "(1,1,1)]", "[3]", "[0,1,2]"), None),
        "count": (mesh(triangle, "[2000000000]", "[0, 1, 2]"), "USD003"),
        "counts": (mesh(triangle, "[" + "3," * (4 * MILLION) + "3]", "[0, 1, 2]"), "USD003"),
        "index": (mesh(triangle, "[3]", "[0, 1, 99999999999999999999]"), "USD003"),
        "infinite": (mesh("[(0, 0, 0), (1, 0, 0), (0, 1e400, 0)]", "[3]", "[0, 1, 2]"), "USD003"),
        "itself": (begin.rstrip() + '\ndef "a" (references = @model.usda@) {}\n', None),
        "string": (begin + 'def "a" {\nstring b = """' + "a" * (8 << 20), "FIL002"),
        "too_large": (begin + " " * (65 << 20), "FIL003"),
        "zeros": ("#usda 1.0\n" + "\0" * MILLION, "FIL002"),
    }


def glb_of(text: bytes, binary: bytes = b"") -> bytes:
    text += b" " * (-len(text) % 4)
    chunk = struct.pack("<II", len(binary), 0x004E4942) + binary if binary else b""
    return struct.pack("<III", 0x46546C67, 2, 20 + len(text) + len(chunk)) + struct.pack("<II", len(text), 0x4E4F534A) + text + chunk


def glb_bombs() -> dict[str, tuple[bytes, str]]:
    def changed(edit) -> bytes:
        document, binary = samples.gltf_gate()
        edit(document)
        return samples.glb(document, binary)

    def text(old: str, new: str) -> bytes:
        document, binary = samples.gltf_gate()
        sound = json.dumps(document)
        assert old in sound, old
        return glb_of(sound.replace(old, new, 1).encode(), binary)

    def chain(document: dict) -> None:
        first = len(document["nodes"])
        document["nodes"] += [{"children": [first + i + 1]} for i in range(200_000)] + [{"mesh": 0}]
        document["nodes"][1].setdefault("children", []).append(first)

    def forest(document: dict) -> None:  # 10 levels of ten to the same node: ten thousand million shapes
        first = len(document["nodes"])
        document["nodes"] += [{"children": [first + i + 1] * 10} for i in range(10)] + [{"mesh": 0}]
        document["nodes"][1].setdefault("children", []).append(first)

    def copies(document: dict) -> None:
        first = len(document["nodes"])
        document["nodes"] += [{"mesh": 0} for _ in range(400_000)]
        document["nodes"][1].setdefault("children", []).extend(range(first, first + 400_000))

    def bodies(document: dict) -> None:
        first = len(document["nodes"])
        mass = document["nodes"][1]["extras"]["mass"]
        document["nodes"] += [{"name": f"b{i}", "extras": {"mass": mass}} for i in range(2_001)]
        document["nodes"][1].setdefault("children", []).extend(range(first, first + 2_001))

    def primitives(document: dict) -> None:
        document["meshes"][0]["primitives"] *= 300_000

    sound, binary = samples.gltf_gate()
    whole = samples.glb(sound, binary)
    json_length = struct.unpack("<I", whole[12:16])[0]
    accessor = sound["accessors"][0]
    return {
        "json_chunk": (whole[:12] + struct.pack("<I", 0xFFFFFFFC) + whole[16:], "GLB001"),
        "json_short": (whole[:12] + struct.pack("<I", 4) + whole[16:], "GLB001"),
        "binary_chunk": (whole[:20 + json_length] + struct.pack("<I", 0xFFFFFFFF) + whole[24 + json_length:], "GLB001"),
        "total": (whole[:8] + struct.pack("<I", 0xFFFFFFFF) + whole[12:], "GLB001"),
        "nested": (glb_of(b'{"asset":{"version":"2.0"},"extras":' + b"[" * MILLION), "FIL002"),
        "nested_objects": (glb_of(b'{"a":' * MILLION), "FIL002"),
        "count": (changed(lambda d: d["accessors"][0].update(count=2**31)), "GLB003"),
        "count_64": (text(f'"count": {accessor["count"]}', '"count": 18446744073709551615'), "FIL006"),
        "count_real": (text(f'"count": {accessor["count"]}', '"count": 1e300'), "FIL006"),
        "count_negative": (text(f'"count": {accessor["count"]}', '"count": -8'), "FIL006"),
        "offset": (changed(lambda d: d["accessors"][0].update(byteOffset=2**63 - 1)), "FIL006"),
        "view_offset": (changed(lambda d: d["bufferViews"][0].update(byteOffset=2**63 - 1)), "FIL006"),
        "view_length": (changed(lambda d: d["bufferViews"][0].update(byteLength=2**63 - 1)), "FIL006"),
        "sparse": (changed(lambda d: d["accessors"][0].update(sparse={
            "count": 2**31, "indices": {"bufferView": 1, "componentType": 5125}, "values": {"bufferView": 0}})), "GLB003"),
        "no_view": (changed(lambda d: (d["accessors"][0].pop("bufferView"), d["accessors"][0].update(count=2**31))), "FIL003"),
        "chain": (changed(chain), "FIL003"),
        "forest": (changed(forest), "GLB006"),
        "copies": (changed(copies), None),
        "bodies": (changed(bodies), None),
        "primitives": (changed(primitives), "FIL003"),
        "no_json": (glb_of(b""), "FIL002"),
        "zeros": (bytes(1 << 20), "FIL002"),
    }


def mesh_bombs() -> dict[str, tuple[str | bytes, str]]:
    """By file name."""
    dae = ('<?xml version="1.0"?>{0}<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
           '<library_geometries><geometry id="g"><mesh><source id="s"><float_array id="f" count="{1}">{2}</float_array>'
           "</source></mesh></geometry></library_geometries></COLLADA>")
    return {
        "laughs.dae": (dae.format(LAUGHS.format(root="COLLADA"), 3, "&a11;"), "GEO005"),
        "count.dae": (dae.format("", 4_000_000_000, "1 2 3"), "GEO005"),
        "nested.dae": ("<COLLADA>" + "<node>" * MILLION, "GEO005"),
        "corners.obj": (samples.OBJ + "f" + " 1" * 3_000_000, "GEO005"),
        "index.obj": (samples.OBJ + "f 1 2 99999999999999999999\n", "GEO005"),
        "triangles.obj": (samples.OBJ + "f 1 2 3\n" * 6_000_000, "GEO005"),
        "count.stl": (bytes(80) + struct.pack("<I", 0xFFFFFFFF) + bytes(500), "GEO005"),
        "count.ply": (samples.PLY.replace("element face 12", "element face 4000000000"), "GEO005"),
        "list.ply": (samples.PLY.replace("3 0 1 3", "4000000000 0 1 3", 1), "GEO005"),
        "properties.ply": ("ply\nformat ascii 1.0\nelement vertex 8\n" + "property float x\n" * MILLION, "GEO005"),
        "count.off": ("OFF\n4000000000 4000000000 0\n", "GEO005"),
        "corners.off": ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", "GEO005"),
        "noise.fbx": (b"Kaydara FBX Binary  \x00\x1a\x00" + struct.pack("<I", 7400) + b"\xff" * 4096, "GEO005"),
        "length.3ds": (struct.pack("<HI", 0x4D4D, 0xFFFFFFFF) + struct.pack("<HI", 0x3D3D, 0xFFFFFFF0) * 1000, "GEO005"),
    }


# What an import takes, since it reads nothing of what is large there.
IMPORTED = {"mjcf_field", "mjcf_texture", "mjcf_stack", "mjcf_key"}


def all_bombs():
    """A name, the file's name, what stands in it, and the rule that `validate` names it by (None: any, or none)."""
    groups = [(kind, lambda kind=kind: xml_bombs(kind)) for kind in XML]
    groups += [("mjcf", mjcf_bombs), ("sdf", sdf_bombs), ("usda", usda_bombs), ("glb", glb_bombs), ("", mesh_bombs)]
    for kind, make in groups:  # one group at a time, for they are large
        for name, (content, code) in make().items():
            yield f"{kind or 'mesh'}_{name.replace('.', '_')}", f"model.{kind}" if kind else name, content, code

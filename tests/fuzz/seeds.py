# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Small sound inputs for the programs of this folder, and the words of their formats:

    seeds.py OUT [MORE...]

writes OUT/<target>/... and OUT/<target>.dict. MORE are folders whose files of a known name are added, such as the
inputs that tests/programs/mutated_input.py makes.
"""
import hashlib
import io
import json
import pathlib
import struct
import sys
import tarfile
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/programs"))
import foreign_samples as samples  # noqa: E402
import sound_inputs as sound  # noqa: E402

LARGEST = 32 << 10  # bytes of a seed that is found


def npy(kind: str, shape: str, content: bytes) -> bytes:
    head = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}"
    head += " " * (-(11 + len(head)) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + content


def small_tar() -> bytes:
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name, content in (("ep0.a.npy", npy("<f4", "(2,)", bytes(8))), ("ep0.meta.json", b"{}")):
            member = tarfile.TarInfo(name)
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    return out.getvalue()[:4096]


def tensors(header: dict, content: bytes) -> bytes:
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    return struct.pack("<Q", len(text)) + text + content


def png(bits: int, colour: int) -> bytes:
    if (bits, colour) == (16, 0):
        return sound.grey_png(4, 3, lambda x, y: 1000 * x + y)
    import zlib

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    row = b"\0" + bytes(4 * bits // 8 * (3 if colour == 2 else 1))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 3, bits, colour, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(row * 3)) + chunk(b"IEND", b""))


def packed_array() -> bytes:
    return (b"\x84\xc4\x0b__ndarray__\xc3\xc4\x04data\xc4\x08" + bytes(8) + b"\xc4\x05dtype\xa3<f4\xc4\x05shape\x92\x01\x02")


def mesh_message() -> bytes:
    """What doorforge-read-mesh sends for nothing but an error."""
    return struct.pack("<QQQ", 0x315252454D464F44, 3, 1) + b"x"


HEAD = ("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n")
PLY_NUMBERS = b"".join(struct.pack("<3f", *p) for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0))) + struct.pack("<B3i", 3, 0, 1, 2)
CANONICAL = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
VISUAL = ("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"
          "\n%%\nnewmtl m\nKd 0.5 0.5 0.5\nd 1\n")
OBJ = "mtllib input.mtl\no a\n" + samples.OBJ + "usemtl m\nvt 0 0\nf 1/1 2/1 3/1 4/1\nf -1//1 -2//1 -3//1\n\n%%\nnewmtl m\nKd 1 0 0\nTr 0.5\nmap_Kd -o 0 0 -mm 0 1 a.png\n"
PIPELINE = sound.CONFIGS["configs/tested_pipeline.yaml"]

MADE = {
    "json": ['{"a": [1, -2.5, "x", null, true, {"b": []}]}', '"\\u00e4\\ud83d\\ude00"'],
    "yaml": [PIPELINE, "a: &a [1, 2]\nb: *a\nc: {d: 'x', e: \"y\"}\nf: |\n  text\n", sound.CAMERA],
    "settings": ["a.b=1\nc=[1, 2]\na.c={x: y}", "scene.seed=2"],
    "torch": [sound.torch_file((1.0, 2.0, 3.0)), npy("<f4", "(3,)", bytes(12)), npy("<f8", "()", bytes(8))],
    "zip": [sound.torch_file((1.0, ))],
    "message": [packed_array(), b"\x82\xa1a\x93\x01\xff\xc0\xa1b\xcb" + bytes(8), b"\x81\xc4\x0e__npgeneric__\xc3"],
    "obj": [OBJ, samples.OBJ],
    "stl": [samples.STL, samples.BINARY_STL],
    "ply": [samples.PLY, b"ply\nformat binary_little_endian 1.0\n" + HEAD.encode() + PLY_NUMBERS,
            "ply\nformat binary_big_endian 1.0\n" + HEAD.replace("float", "uchar") + "\0\0\0\1\0\0\0\1\0\3\0\0\0\0\0\0\0\1\0\0\0\2"],
    "mesh_message": [mesh_message()],
    "collada_frame": [sound.box_dae()],
    "gltf_rotations": [samples.glb(*samples.gltf_box()),
                       json.dumps({"asset": {"version": "2.0"}, "nodes": [{"rotation": [0, 0, 0, 1]}]})],
    "npy": [npy("<f4", "(2, 3)", bytes(24)), npy("|u1", "()", b"x"), npy("<u2", "(0,)", b"")],
    "tar": [small_tar()],
    "safetensors": [tensors({"__metadata__": {"a": "b"}, "x": {"dtype": "F32", "shape": [2], "data_offsets": [0, 8]},
                             "y": {"dtype": "F16", "shape": [], "data_offsets": [8, 10]}}, bytes(10)), tensors({}, b"")],
    "canonical_obj": [CANONICAL],
    "visual_mesh": [VISUAL],
    "urdf": [samples.URDF], "urdf_beside_urdfdom": [samples.URDF], "mjcf": [samples.MJCF], "sdf": [samples.SDF],
    "split": [sound.CONFIGS["configs/tested_split.yaml"]],
    "journal": ['{"episode": {"key": "ep0", "decisions": 1, "members": [{"name": "a", "offset": 512, "size": 0, "crc32c": 0}]}}\n'
                '{"failure": {"key": "ep1", "door_id": "d", "outcome": "door_stuck", "detail": "", "peak_hinge_rad": 0, "peak_handle_rad": 0}}\n'],
    "xml": [samples.URDF, samples.SDF], "foreign_urdf": [samples.URDF], "foreign_sdf": [samples.SDF],
    "foreign_mjcf": [samples.MJCF], "usda": [samples.USDA], "usda_model": [samples.USDA],
    "glb_model": [samples.glb(*samples.gltf_gate())],
    "gltf": [samples.glb(*samples.gltf_box()), json.dumps(samples.gltf_box()[0])],
    "raw_obj": [samples.OBJ], "raw_stl": [samples.STL, samples.BINARY_STL],
    "raw_ply": [samples.PLY, b"ply\nformat binary_little_endian 1.0\n" + HEAD.encode() + PLY_NUMBERS],
    "raw_off": [samples.OFF],
    "dae": [sound.box_dae()], "glb": [samples.glb(*samples.gltf_box())], "off": [samples.OFF],
    "depth_png": [png(16, 0)], "mask_png": [png(8, 0), png(16, 0)],
}
with zipfile.ZipFile(io.BytesIO(sound.torch_file((1.0, 2.0)))) as archive:
    MADE["pickle"] = [archive.read("archive/data.pkl")]



def small_policy() -> str:
    record = json.loads((SOURCE / "data/policies/opener/policy.json").read_text())
    for parts in record["provenance"]["trained_on"].values():
        del parts[1:]
    return json.dumps(record)


def whole_policies() -> list[str]:
    """Of true states, of one that looks, of one that acts on features and of one that says trajectories; without weights."""
    network = {"point_hidden": 64, "point_features": 256, "cloud_hidden": 256, "cloud_features": 112, "hidden": 64, "last_hidden": 64}
    task = {"steps_per_action": 19, "max_actions": 128, "start_distance_m": 0.15, "move_m": 0.025, "turn_rad": 0.15}
    kinds = [
        {"sizes": {"inputs": 40, "hidden": 64, "outputs": 7}, "task": task},
        {"network": "point_net", "sizes": {**network, "point": 7, "own": 19, "outputs": 7}, "task": task,
         "look": {"points": 512, "crop_radius_m": 0.3}},
        {"network": "frozen_point_net", "sizes": {"inputs": 131, "hidden": 64, "outputs": 7}, "sight_sizes": {**network, "point": 7, "own": 19, "outputs": 7},
         "task": task, "look": {"points": 512, "crop_radius_m": 0.3}},
        {"network": "trajectories", "sizes": {**network, "waypoints": 12, "latent": 32},
         "look": {"near_points": 256, "far_points": 256, "near_m": 0.2, "finer": 2},
         "choice": {"contacts": 64, "proposals": 100, "opening_rad": 0.95, "actions": 2}},
    ]
    record = {"schema": "doorforge.policy", "schema_version": 1, "stage": "whole", "weights": "policy.safetensors",
              "weights_sha256": hashlib.sha256(b"").hexdigest()}
    made_from = {"method": "ppo", "config": {}, "code_version": "0.1.0", "decisions": 1,
                 "trained_on": {"bodies": [{"id": "b", "sha256": "1"}], "handles": []}}
    return [json.dumps({**record, **kind, "provenance": made_from}) for kind in kinds]


MADE["policy"] = [small_policy()]
MADE["whole"] = whole_policies()
MADE["curves"] = [(SOURCE / "data/policies/opener/losses.json").read_text()]
MADE["side"] = [(SOURCE / "data/policies/opener/side.safetensors").read_bytes()]
MADE["heights"] = [(SOURCE / "data/policies/opener/pushed/heights.safetensors").read_bytes()]
MADE["turned"] = [(SOURCE / "data/policies/handler/turned.safetensors").read_bytes()]
MADE["familiar"] = [tensors({"__metadata__": {"schema_version": "1"},
                             "mean": {"dtype": "F32", "shape": [1], "data_offsets": [0, 4]}}, bytes(4))]
MADE["pipeline"] = [PIPELINE]

FOUND = {  # by the names of files
    "dataset.json": ["dataset"], "provenance.json": ["provenance"],
    "*.index.json": ["shard_index", "shard_index_file"], "door_index.json": ["door_index"],
    "door.json": ["door", "door_files"], "part.json": ["part"], "report.json": ["report"], "*.urdf": ["urdf", "urdf_beside_urdfdom", "foreign_urdf", "robot"],
    "films.jsonl": ["film"],
}

WORDS = {
    "json": ['"', "{", "}", "[", "]", ":", ",", "null", "true", "false", "1e308", "-0.0", "\\u0000", "\\ud800"],
    "yaml": [": ", "- ", "&a ", "*a", "<<: *a", "!!str ", "!!binary ", "{", "}", "[", "]", "|\n", ">\n", "? ", "---\n", "...\n",
             ".inf", ".nan", "~", "%YAML 1.2\n", "\\x41", "0x10", "1e400"],
    "pickle": ["\x80\x02", "ctorch\nFloatStorage\n", "ctorch._utils\n_rebuild_tensor_v2\n", "ctorch._utils\n_rebuild_parameter\n",
               "X\x07\x00\x00\x00storage", "J\xff\xff\xff\x7f", "\x85", "\x86", "\x87", "Q", "R", "q\x00", "h\x00", "(", "t", "."],
    "zip": ["PK\x01\x02", "PK\x03\x04", "PK\x05\x06", "archive/data.pkl", "archive/data/0"],
    "message": ["\xc4\x0b__ndarray__\xc3", "__npgeneric__", "data", "dtype", "shape", "<f4", "<f8", "|u1", "\xdd\x7f\xff\xff\xff",
                "\xdf\x7f\xff\xff\xff", "\xcf\xff\xff\xff\xff\xff\xff\xff\xff"],
    "obj": ["v ", "vt ", "f ", "o ", "g ", "usemtl ", "mtllib input.mtl\n", "\\\n", "newmtl ", "Kd ", "Tr ", "d ", "map_Kd ", "-blendu on ",
            "-1", "1/1/1", "1//1", "nan", "inf", "1e300", "\n%%\n"],
    "stl": ["solid ", "facet normal ", "outer loop\n", "vertex ", "endloop\n", "endfacet\n", "endsolid ", "nan", "1e300"],
    "ply": ["ply\n", "format ascii 1.0\n", "format binary_little_endian 1.0\n", "format binary_big_endian 1.0\n", "element vertex ",
            "element face ", "property list uchar int vertex_indices\n", "property list double double vertex_index\n",
            "property double x\n", "property uchar red\n", "end_header\n", "comment ", "obj_info ", "\r\n"],
    "off": ["OFF\n", "COFF\n", "NOFF\n", "OFF BINARY\n", "# "],
    "npy": ["\x93NUMPY\x01\x00", "\x93NUMPY\x02\x00", "'descr': ", "'fortran_order': ", "'shape': ", "False", "True", "'<f4'", "'<f8'", "'<i8'",
            "'<u2'", "'|u1'", "()", "(1,)", "(18446744073709551615,)", "(4294967296, 4294967296)"],
    "tar": ["ustar\x0000", "ustar  \x00", "./", "../", "0000644\x00", "77777777777\x00", "\x80\x00\x00\x00\x00\x00\x00\x00"],
    "safetensors": ['"__metadata__"', '"dtype"', '"shape"', '"data_offsets"', "F64", "F32", "F16", "I64", "U8", "18446744073709551615"],
    "mesh_message": ["DOFMESH3", "DOFMERR1", "\x01\x00\x00\x00\x00\x00\x00\x00"],
    "xml": ["<!--", "-->", "<![CDATA[", "]]>", "<?", "?>", "<!DOCTYPE", "&amp;", "&#x41;", "&#0;", "&lt;", "/>", "xmlns:a=", "<a b='", "encoding='"],
    "urdf": ["<robot name='", "<link name='", "<joint name='", "type='revolute'", "type='prismatic'", "type='continuous'", "type='fixed'",
             "<origin xyz='0 0 0' rpy='", "<axis xyz='", "<limit lower='", "upper='", "effort='", "<mimic joint='", "multiplier='",
             "<mesh filename='", "scale='", "<box size='", "<inertia ixx='", "package://", "nan", "1e308", "<calibration", "<dynamics damping='"],
    "mjcf": ["<mujoco>", "<compiler angle='radian' eulerseq='zyx'/>", "<default class='", "childclass='", "<worldbody>", "<body name='",
             "<geom type='", "fromto='", "euler='", "axisangle='", "xyaxes='", "zaxis='", "quat='", "<joint type='hinge'", "<freejoint/>",
             "<include file='", "<mesh name='", "<equality><joint joint1='", "range='", "ref='", "<site ", "<inertial ", "fullinertia='"],
    "sdf": ["<sdf version='1.9'>", "<model name='", "<link name='", "<pose relative_to='", "degrees='true'", "<joint type='", "<parent>", "<child>",
            "<axis><xyz expressed_in='", "<frame name='", "attached_to='", "<static>", "<include>", "__model__", "world", "placement_frame='"],
    "usda": ["#usda 1.0\n", "def Xform \"", "def Mesh \"", "over \"", "class \"", "double3 xformOp:translate = (", "uniform token[] xformOpOrder = [",
             "point3f[] points = [", "int[] faceVertexIndices = [", "rel physics:body0 = </", "prepend apiSchemas = [\"", "variantSet \"",
             "timeSamples = {", "@", "<", ">", '"""', "'''", "None", "dictionary "],
    "glb": ["glTF\x02\x00\x00\x00", "JSON", "BIN\x00", '"byteOffset"', '"byteStride"', '"sparse"', '"extensionsUsed"', "data:application/octet-stream;base64,"],
    "dae": ["<up_axis>", "<unit meter='", "<polylist>", "<vcount>", "<p>", "<source id='", "<float_array count='", "<accessor stride='", "<input semantic='"],
    "png": ["IHDR", "IDAT", "IEND", "PLTE", "tRNS", "gAMA", "sRGB", "iCCP", "\x08\x00\x00\x00\x00"],
}
DICTIONARIES = {
    "json": ["json"], "yaml": ["yaml"], "settings": ["yaml"], "split": ["yaml"], "pipeline": ["yaml"], "robot": ["xml", "urdf"], "journal": ["json"], "torch": ["zip", "pickle", "npy"],
    "pickle": ["pickle"], "zip": ["zip"], "message": ["message"], "obj": ["obj"], "raw_obj": ["obj"], "canonical_obj": ["obj"],
    "visual_mesh": ["obj"], "stl": ["stl"], "raw_stl": ["stl"], "ply": ["ply"], "raw_ply": ["ply"], "raw_off": ["off"], "off": ["off"],
    "mesh_message": ["mesh_message"], "collada_frame": ["xml", "dae"], "dae": ["xml", "dae"], "npy": ["npy"], "tar": ["tar"],
    "safetensors": ["safetensors", "json"], "urdf": ["xml", "urdf"], "urdf_beside_urdfdom": ["xml", "urdf"], "foreign_urdf": ["xml", "urdf"], "mjcf": ["xml", "mjcf"],
    "foreign_mjcf": ["xml", "mjcf"], "sdf": ["xml", "sdf"], "foreign_sdf": ["xml", "sdf"], "xml": ["xml"], "usda": ["usda"], "usda_model": ["usda"], "glb_model": ["glb", "json"],
    "gltf": ["glb", "json"], "glb": ["glb", "json"], "gltf_rotations": ["glb", "json"], "depth_png": ["png"], "mask_png": ["png"],
}


def write_seed(folder: pathlib.Path, content: bytes | str) -> None:
    if isinstance(content, str):
        content = content.encode()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / hashlib.sha1(content).hexdigest()).write_bytes(content)


def escaped(word: str) -> str:
    return "".join(chr(c) if 32 <= c < 127 and chr(c) not in '"\\' else f"\\x{c:02X}" for c in word.encode("latin-1"))


def write_found(out: pathlib.Path, folder: pathlib.Path) -> None:
    for pattern, targets in FOUND.items():
        for path in sorted(folder.rglob(pattern)):
            content = path.read_bytes()
            pieces = content.splitlines()[:3] if path.suffix == ".jsonl" else [content]
            for piece in pieces:
                for target in targets:
                    if len(piece) <= LARGEST:
                        write_seed(out / target, piece)


def main() -> None:
    out = pathlib.Path(sys.argv[1])
    for target, seeds in MADE.items():
        for seed in seeds:
            write_seed(out / target, seed)
    for folder in [SOURCE / "tests/golden", SOURCE / "data/robots", SOURCE / "data/policies", *map(pathlib.Path, sys.argv[2:])]:
        write_found(out, folder)
    for target, names in DICTIONARIES.items():
        words = [word for name in names for word in WORDS[name]]
        (out / f"{target}.dict").write_text("".join(f'"{escaped(word)}"\n' for word in words))


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The small sound inputs that the mutated runs damage, made by the programs and in code; the same for the same build.

    inputs/<group>/<object>

A run copies one group. The objects' names are words of no message, so that a message which has one names the object.
"""
import io
import json
import os
import pathlib
import shutil
import struct
import subprocess
import zipfile
import zlib
from collections.abc import Callable

from sealing import crc32c

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BODY, HANDLE = "interior_flush_01", "interior_lever_tube_01"
DOOR_ID = f"{BODY}__{HANDLE}"
SAFE_BODY, SAFE_HANDLES = "safe_antique_01", ("safe_dial_lever_01", "safe_wheel_three_03")
COLLECT = ("--episodes", "2", "--seed", "3", "--set", "cloud.point_count=256")  # small clouds, for all but training
TRAIN = ("--set", "batch_size=8", "--seed", "1", "--epochs", "1")

BOX_POINTS = [(x, y, z) for z in (0.0, 0.03) for y in (0.0, 0.02) for x in (0.0, 0.12)]
BOX_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
BOX_TRIANGLES = [corners for a, b, c, d in BOX_QUADS for corners in ((a, b, c), (a, c, d))]

CAMERA = """width: 160
height: 120
fx: 110
fy: 110
cx: 79.5
cy: 59.5
depth_unit_m: 0.001
world_from_camera:
  position_m: [1.8, 0, 1.8]
  quaternion_xyzw: [-0.53974355, -0.53974355, 0.45681167, 0.45681167]
"""
STATE = """joint_positions: [0, 0, 0, -0.5, 0, -1.9, 0, 2.9, 0.8, 0.013, 0.013]
joint_velocities: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
world_from_base: {position_m: [0.7, 0, 0.1], quaternion_xyzw: [0, 0, 1, 0]}
unlocked: true
"""
CONFIGS = {  # by group and name
    "configs/tested_scene.yaml": "scene:\n  randomisation: strong\n  physics: {time_step_s: 0.004}\n",
    "configs/tested_collection.yaml":
    "episodes: 4\nseed: 3\nscene:\n  randomisation: paper\ncloud: {point_count: 4096, max_depth_m: 2.5}\n",
    "train/tested_training.yaml": "epochs: 1\nbatch_size: 8\nlearning_rate: 0.001\nframe: hand\n",
    "configs/tested_evaluation.yaml": "seeds: 1\nscene:\n  base_jitter: 0.5\npolicy: {candidates: 1}\n",
    "configs/tested_door.yaml": f"body: {BODY}\nhandle: {HANDLE}\nleaf_width_m: 0.9\nhinge_side: right\nlatch: bolt\n",
    "foreign/tested_import.yaml": "read: {height_m: 1.2}\nmake:\n  repair: {wrap: auto}\n",
    "configs/tested_pipeline.yaml": """schema: doorforge.pipeline
schema_version: 1
about: two steps
settings:
  seed: 7
steps:
  - name: parts
    does: Parts
    command: [catalog, build, --category, safe, --out, "{parts}", --threads, "{threads}"]
    output: parts
    records: [part.json]
    core_seconds: {fixed: 5}
    mebibytes: {fixed: 5}
  - name: doors
    needs: [parts]
    does: Doors
    command: [compose, --all, --parts, "{parts}", --out, "{doors}", --set, "seed={seed}"]
    output: doors
    records: [door.json]
    resume: ""
    core_seconds: {seed: 0.2}
    mebibytes: {fixed: 1}
""",
    "configs/tested_split.yaml":
    f"schema: doorforge.split\nschema_version: 1\ntrain:\n  - {BODY}\n  - {HANDLE}\ntest: []\n",
}


def box_obj(size: tuple[float, float, float] = (1, 1, 1), at: tuple[float, float, float] = (0, 0, 0)) -> str:
    points = [[p[i] * size[i] + at[i] for i in range(3)] for p in BOX_POINTS]
    return "".join("v %g %g %g\n" % tuple(p) for p in points) + "".join("f %d %d %d\n" % tuple(i + 1 for i in t)
                                                                        for t in BOX_TRIANGLES)


def box_dae() -> str:
    positions = " ".join("%g %g %g" % p for p in BOX_POINTS)
    corners = " ".join("%d %d %d" % t for t in BOX_TRIANGLES)
    return (
        '<?xml version="1.0"?>\n<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">\n'
        '<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>\n'
        '<library_geometries><geometry id="g"><mesh>\n'
        f'<source id="p"><float_array id="a" count="24">{positions}</float_array>'
        '<technique_common><accessor source="#a" count="8" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/>'
        '<param name="Z" type="float"/></accessor></technique_common></source>\n'
        '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>\n'
        f'<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{corners}</p></triangles>\n'
        '</mesh></geometry></library_geometries>\n'
        '<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>'
        '</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene url="#s"/></scene></COLLADA>\n')


def box_glb() -> bytes:
    numbers = b"".join(struct.pack("<3f", *p)
                       for p in BOX_POINTS) + b"".join(struct.pack("<3H", *t) for t in BOX_TRIANGLES)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0},
                                    "indices": 1}]}], "buffers": [{"byteLength": len(numbers)}],
        "bufferViews": [{"buffer": 0, "byteLength": 96},
                        {"buffer": 0, "byteOffset": 96, "byteLength": 72}], "accessors": [{
                            "bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0],
                            "max": [0.12, 0.02, 0.03]
                        }, {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    numbers += bytes(-len(numbers) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(numbers), len(text), 0x4E4F534A) + text +
            struct.pack("<II", len(numbers), 0x004E4942) + numbers)


def write_meshes(folder: pathlib.Path) -> None:
    folder.mkdir(parents=True)
    head = ("element vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 6\nproperty list uchar int vertex_indices\nend_header\n")
    rows = "".join("%g %g %g\n" % p for p in BOX_POINTS) + "".join("4 %d %d %d %d\n" % q for q in BOX_QUADS)
    (folder / "tested_box.obj").write_text("mtllib tested_box.mtl\nusemtl a\n" + box_obj())
    (folder / "tested_box.mtl").write_text("newmtl a\nKd 0.2 0.4 0.6\nd 1\n")
    (folder / "tested_box.off").write_text("OFF\n8 6 0\n" + rows)
    (folder / "tested_box.ply").write_text("ply\nformat ascii 1.0\n" + head + rows)
    (folder / "binary_box.ply").write_bytes(("ply\nformat binary_little_endian 1.0\n" + head).encode() +
                                            b"".join(struct.pack("<3f", *p) for p in BOX_POINTS) +
                                            b"".join(struct.pack("<B4i", 4, *q) for q in BOX_QUADS))
    (folder / "tested_box.stl").write_bytes(
        bytes(80) + struct.pack("<I", 12) + b"".join(
            struct.pack("<12fH", 0, 0, 0, *[n for corner in t for n in BOX_POINTS[corner]], 0) for t in BOX_TRIANGLES))
    (folder / "text_box.stl").write_text("solid a\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % BOX_POINTS[corner]
                                                     for corner in t) + "endloop\nendfacet\n"
        for t in BOX_TRIANGLES) + "endsolid a\n")
    (folder / "tested_box.dae").write_text(box_dae())
    (folder / "tested_box.glb").write_bytes(box_glb())


def write_object(folder: pathlib.Path, urdf: str) -> None:
    """A cupboard of boxes: a body, a door hinged to it, a handle on the door."""
    folder.mkdir(parents=True)
    boxes = {
        "body": ((5, 20, 60), (0, 0.05, 0)), "door": ((5, 1, 60), (0, 0, 0)),
        "handle": ((0.25, 2, 6), (0.5, -0.04, 0.8))
    }
    for name, (size, at) in boxes.items():
        (folder / f"{name}.obj").write_text(box_obj(size, at))
    links = "".join(
        f'<link name="{name}"><visual><geometry><mesh filename="{name}.obj"/></geometry></visual></link>\n'
        for name in boxes)
    (folder / urdf).write_text(
        f'<?xml version="1.0"?>\n<robot name="cupboard">\n{links}'
        '<joint name="hinge" type="revolute"><parent link="body"/><child link="door"/>'
        '<origin xyz="0 0 0"/><axis xyz="0 0 1"/>'
        '<limit lower="-1.57" upper="0" effort="10" velocity="1"/></joint>\n'
        '<joint name="mount" type="fixed"><parent link="door"/><child link="handle"/></joint>\n</robot>\n')


def torch_file(numbers: tuple[float, ...]) -> bytes:
    """What torch.save writes for a tensor of floats."""

    def text(word: str) -> bytes:
        return b"X" + struct.pack("<I", len(word)) + word.encode()

    storage = b"(" + text("storage") + b"ctorch\nFloatStorage\n" + text("0") + text("cpu") + b"K%ctQ" % len(numbers)
    pickle = (b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\n(" + storage +
              b"K\x00K%c\x85K\x01\x85\x89ccollections\nOrderedDict\n)RtR." % len(numbers))
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as target:
        for name, body in (("data.pkl", pickle), ("data/0", struct.pack(f"<{len(numbers)}f",
                                                                        *numbers)), ("version", b"3\n")):
            target.writestr(zipfile.ZipInfo(f"archive/{name}"), body)
    return out.getvalue()


def write_foreign(folder: pathlib.Path) -> None:
    """Objects as the data sets have them, one a folder."""
    write_object(folder / "objects/plain/tested_object", "tested.urdf")
    write_object(folder / "objects/partnet/7777001", "mobility.urdf")
    (folder / "objects/partnet/7777001/semantics.txt"
     ).write_text("body heavy cabinet_body\ndoor hinge door\nhandle static handle\n")
    (folder / "objects/partnet/7777001/meta.json").write_text('{"model_cat": "StorageFurniture"}')
    handle = folder / "objects/unidoormanip/lever_door_handle/9977001"
    (handle / "texture_dae").mkdir(parents=True)
    (handle / "texture_dae/9977001.obj").write_text(box_obj())
    (handle / "bounding_box.json").write_text('{"handle": [[0, 0, 0], [0.12, 0.02, 0.03]]}\n')
    (handle / "goal_pos.npy").write_bytes(torch_file((0.06, 0.01, 0.02)))
    knob = folder / "objects/doorgym/leverknobs/7700001"
    knob.mkdir(parents=True)
    for name in ("body_1", "body_2"):
        triangles = [[1000 * n for corner in t for n in BOX_POINTS[corner]] for t in BOX_TRIANGLES]
        (knob / f"{name}.stl").write_bytes(
            bytes(80) + struct.pack("<I", 12) + b"".join(struct.pack("<12fH", 0, 0, 0, *t, 0) for t in triangles))
    (knob / "info.json").write_text(
        '{"version": 2, "model_names": ["body_1", "body_2"], '
        '"bounding_box": [{"min": [0, 0, 0], "max": [120, 20, 30]}]}\n'
    )


def grey_png(width: int, height: int, pixel: Callable[[int, int], int]) -> bytes:
    """16 bit."""
    rows = b"".join(b"\0" + b"".join(struct.pack(">H", pixel(x, y)) for x in range(width)) for y in range(height))

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 0)) + chunk(b"IEND", b""))


def write_sight(folder: pathlib.Path) -> None:
    for policy in ("opener", "handler", "grasper"):
        shutil.copytree(SOURCE / "data/policies" / policy, folder / f"tested_{policy}")
    (folder / "tested_camera.yaml").write_text(CAMERA)
    (folder / "tested_state.yaml").write_text(STATE)
    (folder / "tested_depth.png").write_bytes(grey_png(160, 120, lambda x, y: 1500 + 2 * x + 5 * y))
    (folder / "tested_before.png").write_bytes(grey_png(320, 240, lambda x, y: 1500 + x + 2 * y))
    (folder / "tested_mask.png").write_bytes(grey_png(160, 120, lambda x, y: 1 if 70 <= x < 90 and 50 <= y < 70 else 0))


def write_begun_shard(data: pathlib.Path, begun: pathlib.Path) -> None:
    """The data set as a killed collection leaves it: its shard unfinished, the journal beside it."""
    shutil.copytree(data, begun)
    (begun / "dataset.json").unlink()
    index_path = next(begun.rglob("*.index.json"))
    index = json.loads(index_path.read_text(), parse_float=lambda digits: "@real@" + digits)
    tar = index_path.with_name(index["tar"])
    head = {"schema": "doorforge.shard_journal", "schema_version": 1}
    entries = [{**head, **{key: index[key]
                           for key in ("number", "stage", "split", "config_sha256")}},
               {"episode": index["episodes"][0]}]
    lines = [json.dumps(entry, separators=(",", ":")).encode() for entry in entries]
    stem = tar.name.removesuffix(".tar")
    (tar.parent / f".{stem}.journal").write_bytes(b"".join(b"%08x %s\n" % (crc32c(line), line) for line in lines))
    last = index["episodes"][0]["members"][-1]
    (tar.parent / f".{stem}.tar.partial").write_bytes(tar.read_bytes()[:last["offset"] + -(-last["size"] // 512) * 512])
    tar.unlink()
    index_path.unlink()


def write_small_catalogue(data: pathlib.Path, parts: tuple = (SAFE_BODY, SAFE_HANDLES[0])) -> None:
    """The data of programs (DOORFORGE_DATA) with a catalogue of these parts."""
    shutil.copytree(SOURCE / "data/families", data / "families")
    for name in parts:
        recipe = next((SOURCE / "data/catalog").rglob(f"{name}.yaml"))
        target = data / "catalog" / recipe.relative_to(SOURCE / "data/catalog")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(recipe, target)


def make_inputs(doorforge: pathlib.Path, folder: pathlib.Path) -> None:

    def run(*arguments: object, **environment: str) -> None:
        answer = subprocess.run([str(doorforge), *map(str, arguments)], capture_output=True, text=True, timeout=600,
                                env=dict(os.environ, **environment))
        if answer.returncode != 0:
            raise SystemExit(f"{arguments}: exit code {answer.returncode}\n{answer.stderr}")

    door = folder / "doors/tested_door"
    run("compose", "--body", BODY, "--handle", HANDLE, "--out", door)
    shutil.copytree(door, folder / "doors/other_door")
    for name in ("configs", "robots", "data", "begun", "report"):
        shutil.copytree(door, folder / name / "tested_door")
    data = folder / "data/tested_set"
    run("datagen", "open", "--doors", door, "--out", data, *COLLECT)
    write_begun_shard(data, folder / "begun/tested_set")
    run("datagen", "open", "--doors", door, "--out", folder / "train/tested_set", "--episodes", 2, "--seed", 3)
    shutil.copytree(folder / "train/tested_set", folder / "trained/tested_set")
    run("train", "open", "--data", folder / "trained/tested_set", "--out", folder / "trained/tested_training", *TRAIN)

    run("eval", "--opener", "expert", "--doors", door, "--seeds", 1, "--set", "scene.physics.max_opening_actions=4", "--films",
        "--out", folder / "report/tested_report")
    for name in ("report.html", "films.html"):
        (folder / "report/tested_report" / name).unlink()

    write_small_catalogue(folder / "three", (SAFE_BODY, *SAFE_HANDLES))
    run("catalog", "build", "--out", folder / "parts", DOORFORGE_DATA=str(folder / "three"))
    shutil.rmtree(folder / "three")
    shutil.copytree(folder / "parts" / SAFE_BODY, folder / "part/other_body")
    shutil.copytree(folder / "parts" / SAFE_HANDLES[0], folder / "part/tested_part")
    shutil.copytree(folder / "parts", folder / "pool/parts")
    run("compose", "--all", "--parts", folder / "parts", "--out", folder / "pool/tested_doors")

    write_small_catalogue(folder / "catalogue/tested_data")
    shutil.copytree(SOURCE / "data/policies/pipeline", folder / "pipeline/tested_run/pipeline")
    shutil.copytree(SOURCE / "data/robots/mobile_franka", folder / "robots/tested_robot")
    write_meshes(folder / "meshes")
    write_foreign(folder / "foreign")
    write_sight(folder / "sight")
    for name, text in CONFIGS.items():
        (folder / name).write_text(text)

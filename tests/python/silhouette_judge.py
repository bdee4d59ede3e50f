# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a data set beside those that programs of others make of the exported doors and the robot's URDF.

    silhouette_judge.py DATA EXPORTED ROBOT.urdf [NODE_MODULES]

DATA has the streams `link`, `label` and `depth32` of one camera at least; EXPORTED is a folder of the same doors in MJCF, GLB and
URDF. MuJoCo's renderer draws door and robot from MJCF and URDF, three.js in headless Chromium from GLB and URDF (with
NODE_MODULES, which holds `three` and `urdf-loader`): what they cover must overlap by 0.98, intersection over union, the whole and
the leaf, frame and robot by themselves where they are large. trimesh casts rays at the meshes of both URDFs, as yourdfpy poses
them: links and labels must be the same and the depths within 0.01 mm, but where a ray runs along an edge. Prints a row a picture; exit code 1 if one misses.
"""
import functools
import http.server
import io
import json
import math
import os
import pathlib
import re
import sys
import threading

os.environ.setdefault("MUJOCO_GL", "egl")
root = pathlib.Path(__file__).parents[2]
sys.path[:0] = [str(root / "python"), str(root / "tests/view")]

import mujoco
import numpy as np
import trimesh
import yourdfpy

import doorforge_reader

LEAST_OVERLAP = 0.98
RAY_STEP = 4  # rays are cast through one pixel of so many each way
DEPTH_OFF_M = 1e-5
EDGE_PX = 0.02  # an edge is no farther from a ray that may meet either side
SMALL = 1500  # pixels; of what is smaller the edge alone is more than two in a hundred
FRAME, LEAF, HANDLE, ROBOT, NOTHING = 0, 1, 2, 3, 255
NAMES = {FRAME: "frame", LEAF: "leaf", HANDLE: "handle", ROBOT: "robot"}
LABEL_OF_LINK = np.array([2, 0, 1, 3], np.uint8)
DOOR_LINKS = {"base": FRAME, "leaf": LEAF, "handle": HANDLE}
DOOR_JOINTS = ("hinge", "handle_joint")
ROBOT_JOINTS = ("z_free_base1", "z_free_base2", *(f"panda_joint{i}" for i in range(1, 8)), "panda_finger_joint1", "panda_finger_joint2")


class View:
    """One decision of one camera: what the data set says of it."""

    def __init__(self, episode, camera: str, decision: int) -> None:
        meta = episode.meta
        self.door, self.camera, self.decision = meta["scene"]["door_id"], camera, decision
        link = np.asarray(episode[f"link_{camera}"][decision])
        self.links = np.where(link == 255, NOTHING, np.minimum(link, ROBOT)).astype(np.uint8)
        self.labels = np.asarray(episode[f"label_{camera}"][decision])
        self.depth_m = np.asarray(episode[f"depth32_{camera}"][decision])
        self.world_from_camera = square(episode[f"pose_{camera}"][decision])
        self.intrinsics = np.array(meta["pictures"][camera]["intrinsic_matrix_px"])
        self.world_from_door = square(meta["poses"]["world_from_door_rows"])
        self.world_from_robot = square(meta["poses"]["world_from_robot_base_rows"])
        state = np.asarray(episode["state"][decision])
        self.robot_joints = dict(zip(ROBOT_JOINTS, map(float, state[:11])))
        self.door_joints = dict(zip(DOOR_JOINTS, map(float, state[11:13])))
        self.height, self.width = self.links.shape
        self.fovy_rad = 2 * math.atan(self.height / 2 / self.intrinsics[1, 1])

    def __str__(self) -> str:
        return f"{self.door[:44]:44} {self.camera:6} {self.decision:3}"


def square(pose) -> np.ndarray:
    return np.vstack([np.asarray(pose, float).reshape(3, 4), [0, 0, 0, 1]])


def by_mujoco(view: View, mjcf: pathlib.Path, robot: pathlib.Path) -> np.ndarray:
    spec = mujoco.MjSpec()
    for name, path, pose in (("door/", mjcf, view.world_from_door), ("robot/", robot, view.world_from_robot)):
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, pose[:3, :3].flatten())
        spec.attach(mujoco.MjSpec.from_file(str(path)), prefix=name, frame=spec.worldbody.add_frame(pos=pose[:3, 3], quat=quaternion))
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, (view.world_from_camera[:3, :3] @ np.diag([1, -1, -1])).flatten())
    spec.worldbody.add_camera(name="judge", pos=view.world_from_camera[:3, 3], quat=quaternion, fovy=math.degrees(view.fovy_rad))
    spec.visual.global_.offwidth, spec.visual.global_.offheight = view.width, view.height
    model = spec.compile()
    model.vis.map.znear, model.vis.map.zfar = 0.01 / model.stat.extent, 50 / model.stat.extent
    data = mujoco.MjData(model)
    for prefix, joints in (("door/", view.door_joints), ("robot/", view.robot_joints)):
        for name, angle in joints.items():
            joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, prefix + name)
            if joint >= 0:  # a handle that does not turn has none
                data.qpos[model.jnt_qposadr[joint]] = angle
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    option = mujoco.MjvOption()
    option.geomgroup[:] = [0, 1, 1, 0, 0, 0]  # a URDF's visual geoms are in group 1, the door's in 2
    option.sitegroup[:] = 0
    with mujoco.Renderer(model, view.height, view.width) as renderer:
        renderer.enable_segmentation_rendering()
        renderer.update_scene(data, "judge", option)
        geoms = renderer.render()[:, :, 0]
    link_of_geom = np.full(model.ngeom + 1, NOTHING, np.uint8)
    for geom in range(model.ngeom):
        body = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, model.geom_bodyid[geom])
        link_of_geom[geom] = DOOR_LINKS.get(body.removeprefix("door/"), NOTHING) if body and body.startswith("door/") else ROBOT
    return link_of_geom[geoms]  # -1 is the last


PAGE = """<!doctype html><script type="importmap">{"imports": {"three": "/node_modules/three/build/three.module.js",
"three/addons/": "/node_modules/three/examples/jsm/", "three/examples/jsm/": "/node_modules/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import URDFLoader from "/node_modules/urdf-loader/src/URDFLoader.js";

const renderer = new THREE.WebGLRenderer({ antialias: false });
const matrix = (rows) => new THREE.Matrix4().set(...rows.flat());
const placed = (object, pose) => {  // what the file turned upright for glTF stays so within
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  group.matrix.copy(pose);
  group.add(object);
  return group;
};
const paint = (object, link) => object.traverse((node) => {
  if (node.isMesh) node.material = new THREE.MeshBasicMaterial({ color: new THREE.Color().setRGB((link + 1) / 255, 0, 0), side: THREE.DoubleSide, toneMapped: false });
});
const robotOf = (url) => new Promise((done, failed) => {
  const manager = new THREE.LoadingManager();
  let robot;
  manager.onLoad = () => done(robot);
  manager.onError = failed;
  const loader = new URDFLoader(manager);
  loader.loadMeshCb = (path, meshes, material, loaded) => new OBJLoader(meshes).load(path, loaded, undefined, failed);
  loader.load(url, (result) => { robot = result; });
});
let robot;
window.draw = async (view) => {
  robot ??= await robotOf(view.robot);
  for (const [name, value] of Object.entries(view.robot_joints)) robot.setJointValue(name, value);
  paint(robot, 3);
  const door = (await new GLTFLoader().loadAsync(view.glb)).scene;
  const nodes = new Map();
  door.traverse((node) => { if (node.userData.joint) nodes.set(node.userData.joint.name, node); });
  for (const [name, angle] of Object.entries(view.door_joints)) {
    const node = nodes.get(name);
    if (node?.userData.joint.axis) node.quaternion.multiply(new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(...node.userData.joint.axis), angle));
  }
  paint(door, 0);
  if (nodes.has("hinge")) paint(nodes.get("hinge"), 1);
  if (nodes.has("handle_joint")) paint(nodes.get("handle_joint"), 2);
  const scene = new THREE.Scene();
  // glTF is y up: its root is turned back to the door's z up
  const upright = new THREE.Matrix4().makeRotationX(Math.PI / 2);
  scene.add(placed(door, matrix(view.world_from_door).multiply(upright)), placed(robot, matrix(view.world_from_robot)));
  const camera = new THREE.PerspectiveCamera(view.fovy_deg, view.width / view.height, 0.01, 50);
  camera.matrixAutoUpdate = false;
  camera.matrix.copy(matrix(view.world_from_camera).multiply(new THREE.Matrix4().makeScale(1, -1, -1)));
  scene.updateMatrixWorld(true);
  camera.updateMatrixWorld(true);
  const target = new THREE.WebGLRenderTarget(view.width, view.height);
  renderer.setRenderTarget(target);
  renderer.setClearColor(0, 0);
  renderer.clear();
  renderer.render(scene, camera);
  const pixels = new Uint8Array(4 * view.width * view.height);
  renderer.readRenderTargetPixels(target, 0, 0, view.width, view.height, pixels);
  target.dispose();
  return Array.from({ length: view.width * view.height }, (_, i) => pixels[4 * i] - 1);
};
document.documentElement.dataset.ready = "";
</script>"""


class Files(http.server.SimpleHTTPRequestHandler):
    """Serves the page, and the folders that `roots` names."""

    roots: dict[str, pathlib.Path] = {}

    def do_GET(self) -> None:
        if self.path != "/":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(PAGE.encode())

    def translate_path(self, path: str) -> str:
        name, _, rest = path.lstrip("/").partition("/")
        return str(self.roots.get(name, pathlib.Path("/nonexistent")) / rest)

    def log_message(self, *_: object) -> None:
        pass


class ThreeJs:
    def __init__(self, exported: pathlib.Path, robot: pathlib.Path, node_modules: pathlib.Path) -> None:
        import browser
        Files.roots = {"exported": exported, "robot": robot.parent, "node_modules": node_modules}
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Files)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.robot = f"/robot/{robot.name}"
        self.page = browser.Browser()
        self.page.open(f"http://127.0.0.1:{self.server.server_port}/")

    def links(self, view: View) -> np.ndarray:
        asked = {"glb": f"/exported/{view.door}/model.glb", "robot": self.robot, "door_joints": view.door_joints, "robot_joints": view.robot_joints,
                 "width": view.width, "height": view.height, "fovy_deg": math.degrees(view.fovy_rad)}
        asked |= {name: getattr(view, name).tolist() for name in ("world_from_door", "world_from_robot", "world_from_camera")}
        pixels = np.array(self.page.js(f"draw({json.dumps(asked)})"), np.int16).reshape(view.height, view.width)[::-1]
        return np.where(pixels < 0, NOTHING, pixels).astype(np.uint8)

    def close(self) -> None:
        self.page.__exit__()
        self.server.shutdown()


@functools.cache
def described(path: pathlib.Path) -> yourdfpy.URDF:
    # the two fingers are told where they are one by one: a hand that holds something lets them differ a little
    text = io.BytesIO(re.sub(r"<mimic[^>]*/>", "", path.read_text()).encode())
    return yourdfpy.URDF.load(text, load_collision_meshes=False, filename_handler=lambda fname: str(path.parent / fname))


class Meshes:
    """Door and robot as yourdfpy poses them, for trimesh's own rays, which are not Embree's."""

    def __init__(self, view: View, door: pathlib.Path, robot: pathlib.Path) -> None:
        meshes, links, labels = [], [], []
        for path, joints, pose in ((door, view.door_joints, view.world_from_door), (robot, view.robot_joints, view.world_from_robot)):
            model = described(path)
            model.update_cfg({name: value for name, value in joints.items() if name in model.actuated_joint_names})
            for node in model.scene.graph.nodes_geometry:
                transform, geometry = model.scene.graph[node]
                parent = model.scene.graph.transforms.parents[node]
                link = ROBOT if path == robot else DOOR_LINKS.get(parent)
                if link is None:  # the bolt, which no picture shows
                    continue
                mesh = model.scene.geometry[geometry].copy()
                mesh.apply_transform(pose @ transform)
                meshes.append(mesh)
                links.append(np.full(len(mesh.faces), link, np.uint8))
                # a rose stands still on the leaf, and is a part of the handle
                labels.append(np.full(len(mesh.faces), LABEL_OF_LINK[HANDLE if node.startswith("rose") else link], np.uint8))
        self.view, self.links, self.labels = view, np.concatenate(links), np.concatenate(labels)
        self.caster = trimesh.ray.ray_triangle.RayMeshIntersector(trimesh.util.concatenate(meshes))

    def seen(self, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Links, labels, and depths along the optical axis, at (column, row) of which (0.5, 0.5) is the first pixel's centre."""
        view = self.view
        in_camera = np.column_stack([pixels, np.ones(len(pixels))]) @ np.linalg.inv(view.intrinsics).T
        directions = in_camera @ view.world_from_camera[:3, :3].T
        origins = np.broadcast_to(view.world_from_camera[:3, 3], directions.shape)
        points, rays, faces = self.caster.intersects_location(origins, directions, multiple_hits=False)
        links, labels, depths = np.full(len(pixels), NOTHING, np.uint8), np.full(len(pixels), NOTHING, np.uint8), np.zeros(len(pixels))
        links[rays], labels[rays] = self.links[faces], self.labels[faces]
        depths[rays] = (points - origins[rays]) @ view.world_from_camera[:3, 2]
        return links, labels, depths


def overlap(ours: np.ndarray, theirs: np.ndarray) -> float:
    return float((ours & theirs).sum() / max((ours | theirs).sum(), 1))


def judge(name: str, view: View, theirs: np.ndarray) -> bool:
    whole = overlap(view.links != NOTHING, theirs != NOTHING)
    sound, parts = whole > LEAST_OVERLAP, []
    for link, title in NAMES.items():
        size = int((view.links == link).sum())
        if size == 0:
            continue
        share = overlap(view.links == link, theirs == link)
        parts.append(f"{title} {share:.4f} of {size}")
        sound &= size < SMALL or share > LEAST_OVERLAP
    print(f"{view} {name:8} whole {whole:.4f}, {', '.join(parts)}{'' if sound else '  MISSED'}", flush=True)
    return sound


def judge_rays(view: View, door: pathlib.Path, robot: pathlib.Path) -> bool:
    """At an edge either surface may be met: where the two differ, rays close by must find what we found."""
    meshes = Meshes(view, door, robot)
    rows, columns = (grid.ravel() for grid in np.mgrid[RAY_STEP // 2:view.height:RAY_STEP, RAY_STEP // 2:view.width:RAY_STEP])
    pixels = np.column_stack([columns, rows]) + 0.5
    ours, our_links, our_depths = (image[rows, columns] for image in (view.labels, view.links, view.depth_m))

    def same(at: np.ndarray, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        links, labels, depths = meshes.seen(at)
        off = np.where(ours[which] == NOTHING, 0, np.abs(depths - our_depths[which]))
        return (links == our_links[which]) & (labels == ours[which]) & (off < DEPTH_OFF_M), off

    every = np.arange(len(pixels))
    agree, off = same(pixels, every)
    differ = np.flatnonzero(~agree)
    found = np.zeros(len(differ), bool)
    for angle in np.arange(8) * math.pi / 4:
        if len(differ):
            found |= same(pixels[differ] + EDGE_PX * np.array([math.cos(angle), math.sin(angle)]), differ)[0]
    sound = bool(found.all())
    print(f"{view} trimesh  {agree.sum()} of {len(pixels)} links, labels and depths, these within {off[agree].max() * 1000:.4f} mm; {found.sum()} at an edge, "
          f"{(~found).sum()} otherwise{'' if sound else '  MISSED'}", flush=True)
    return sound


def main() -> int:
    data, exported, robot = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    three = ThreeJs(exported, robot, pathlib.Path(sys.argv[4]).resolve()) if len(sys.argv) > 4 else None
    sound, count = True, 0
    for episode in doorforge_reader.Dataset(data).episodes("open", "train"):
        for camera in episode.cameras():
            decisions = len(episode["state"])
            for decision in sorted({0, decisions // 2, decisions - 1}):
                view = View(episode, camera, decision)
                door = exported / view.door
                sound &= judge("mujoco", view, by_mujoco(view, door / "model.xml", robot))
                if three is not None:
                    sound &= judge("three.js", view, three.links(view))
                sound &= judge_rays(view, door / "model.urdf", robot)
                count += 1
    if three is not None:
        three.close()
    print(f"{count} pictures: {'all agree' if sound and count else 'MISSED'}")
    return 0 if sound and count else 1


if __name__ == "__main__":
    sys.exit(main())

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the page draws, and where: outlines of doors against a rasteriser in numpy that reads URDF and OBJ, outlines of handles
against the pictures of `doorforge preview`.

usage: silhouette_test.py BUILD"""
import base64
import pathlib
import unittest
import xml.etree.ElementTree

import numpy as np

from kinematics import numbers, poses_of_urdf, turned
from pages import PageTest, run

WIDTH, HEIGHT = 640, 480
LEAST = 0.98  # intersection over union
ACROSS = 0.7  # [rad] across the picture, as previews have
AZIMUTH, ELEVATION, MARGIN = np.radians(-34), 0.35, 1.08


class Camera:
    """That of a preview: it looks at the middle of the box about the points from where all are in view."""

    def __init__(self, points: np.ndarray) -> None:
        self.target = (points.min(0) + points.max(0)) / 2
        away = np.array([np.cos(ELEVATION) * np.cos(AZIMUTH), np.cos(ELEVATION) * np.sin(AZIMUTH), np.sin(ELEVATION)])
        right = np.cross(-away, [0, 0, 1])
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(-away, right), -away])  # right, down, forward
        wide = np.tan(ACROSS / 2)
        seen = (points - self.target) @ self.axes.T
        needed = np.maximum(abs(seen[:, 0]) / wide, abs(seen[:, 1]) / (wide * HEIGHT / WIDTH)) - seen[:, 2]
        self.position = self.target + MARGIN * max(0.1, needed.max()) * away
        self.focal = WIDTH / 2 / wide

    def pixels(self, points: np.ndarray) -> np.ndarray:
        seen = (points - self.position) @ self.axes.T
        return np.stack([WIDTH / 2 + self.focal * seen[:, 0] / seen[:, 2], HEIGHT / 2 + self.focal * seen[:, 1] / seen[:, 2]], 1)


def read_obj(path: pathlib.Path) -> tuple[np.ndarray, np.ndarray]:
    lines = [line.split() for line in path.read_text().splitlines()]
    return (np.array([[float(word) for word in line[1:]] for line in lines if line[0] == "v"]),
            np.array([[int(word) - 1 for word in line[1:]] for line in lines if line[0] == "f"]))


def rasterised(corners: np.ndarray) -> np.ndarray:
    """The pixels whose middles lie in one of the triangles, T x 3 x 2."""
    mask = np.zeros((HEIGHT, WIDTH), bool)
    for a, b, c in corners:
        left, top = np.maximum(np.floor(np.min([a, b, c], 0)).astype(int), 0)
        right, bottom = np.minimum(np.ceil(np.max([a, b, c], 0)).astype(int) + 1, (WIDTH, HEIGHT))
        if left >= right or top >= bottom:
            continue
        x, y = np.meshgrid(np.arange(left, right) + 0.5, np.arange(top, bottom) + 0.5)
        sides = [(q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in ((a, b), (b, c), (c, a))]
        mask[top:bottom, left:right] |= np.logical_or(np.min(sides, 0) >= 0, np.max(sides, 0) <= 0)
    return mask


def triangles_of_door(folder: pathlib.Path, angles: dict[str, float]) -> np.ndarray:
    poses = poses_of_urdf(folder / "model.urdf", angles)
    found = []
    for link in xml.etree.ElementTree.parse(folder / "model.urdf").getroot().findall("link"):
        for visual in link.findall("visual"):
            vertices, triangles = read_obj(folder / visual.find("geometry/mesh").get("filename"))
            origin = visual.find("origin")
            if origin is not None:
                roll, pitch, yaw = numbers(origin.get("rpy"))
                turn = turned(np.array([0, 0, 1.0]), yaw) @ turned(np.array([0, 1.0, 0]), pitch) @ turned(np.array([1.0, 0, 0]), roll)
                vertices = vertices @ turn.T + numbers(origin.get("xyz"))
            pose = poses[link.get("name")]
            found.append((vertices @ pose[:3, :3].T + pose[:3, 3])[triangles])
    return np.concatenate(found)


def overlap(a: np.ndarray, b: np.ndarray) -> float:
    return np.logical_and(a, b).sum() / np.logical_or(a, b).sum()


class Silhouette(PageTest):
    def unpacked(self, text: str) -> np.ndarray:
        return np.unpackbits(np.frombuffer(base64.b64decode(text), np.uint8))[:WIDTH * HEIGHT].reshape(HEIGHT, WIDTH).astype(bool)

    def drawn(self, camera: Camera) -> np.ndarray:
        """Where the page's canvas, of the preview's size and with its camera, has another colour than its paper."""
        self.browser.js(
            "(() => { const { stage, model } = doorforge.view; model.show({ shapes: 'visual', frames: false, grasp: false, scale: false });"
            " if (model.bolt) model.bolt.visible = false; for (const child of model.links[0].children) if (child.isMesh) child.visible = false;"  # the strike
            " stage.floor.visible = false; stage.scene.background.set(0xff00ff); stage.renderer.setPixelRatio(1);"
            f" stage.renderer.setSize({WIDTH}, {HEIGHT}, false); stage.camera.aspect = {WIDTH / HEIGHT}; stage.camera.fov = {np.degrees(2 * np.arctan(np.tan(ACROSS / 2) * HEIGHT / WIDTH))};"
            f" stage.camera.position.set({','.join(map(str, camera.position))}); stage.controls.target.set({','.join(map(str, camera.target))}); stage.camera.near = 0.005;"
            " stage.controls.enableDamping = false; stage.controls.update(); stage.camera.updateProjectionMatrix(); return 0; })()")
        return self.unpacked(self.browser.js(
            "(() => { const { stage } = doorforge.view; stage.draw(); const gl = stage.renderer.getContext();"
            f" const w = {WIDTH}, h = {HEIGHT}, p = new Uint8Array(w * h * 4); gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, p);"
            " const bits = new Uint8Array(w * h / 8); for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) { const at = 4 * ((h - 1 - y) * w + x);"
            " const paper = p[at] > 250 && p[at + 1] < 5 && p[at + 2] > 250; if (!paper) bits[(y * w + x) >> 3] |= 128 >> (x & 7); }"
            " return btoa(String.fromCharCode(...bits)); })()"))

    def test_doors_are_drawn_where_their_files_say(self) -> None:
        for settings in ((), ("--set", "hinge_side=right", "--set", "opening=push")):
            folder = self.folder / f"door{len(settings)}"
            run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", *settings, "--out", folder)
            self.open(folder.name)
            for hinge, handle in ((0, 0), (0.6, 0.7), (1.4, 0.55)):
                triangles = triangles_of_door(folder, {"hinge": hinge, "handle_joint": handle})
                camera = Camera(triangles.reshape(-1, 3))
                expected = rasterised(camera.pixels(triangles.reshape(-1, 3)).reshape(-1, 3, 2))
                self.browser.js(f"(doorforge.view.turnHandle({handle}), doorforge.view.moveHinge({hinge}), 0)")
                share = overlap(self.drawn(camera), expected)
                print(f"{folder.name}, hinge {hinge}, handle {handle}: {share:.4f}")
                self.assertGreater(share, LEAST)

    def test_handles_are_drawn_as_previews_draw_them(self) -> None:
        run("catalog", "build", "--category", "safe", "--out", self.folder / "parts")
        for part in ("safe_dial_lever_01", "safe_ell_02"):
            picture = self.folder / f"{part}.png"
            run("preview", self.folder / "parts" / part, "--focus", "whole", "--width", WIDTH, "--out", picture)
            self.open(f"parts/{part}")
            meshes = [path for path in (self.folder / "parts" / part / "meshes").glob("*.obj") if "_hull_" not in path.name]
            camera = Camera(np.concatenate([read_obj(path)[0] for path in meshes]))
            # the paper of a preview is the same along a row but for a little; its first pixels show it
            seen = self.unpacked(self.browser.js(
                f"(async () => {{ const image = new Image(); image.src = 'data:image/png;base64,{base64.b64encode(picture.read_bytes()).decode()}'; await image.decode();"
                f" const w = {WIDTH}, h = {HEIGHT}; const pen = Object.assign(document.createElement('canvas'), {{ width: w, height: h }}).getContext('2d');"
                " pen.drawImage(image, 0, 0); const p = pen.getImageData(0, 0, w, h).data; const bits = new Uint8Array(w * h / 8);"
                " for (let y = 0; y < h; ++y) { const edge = 4 * y * w; for (let x = 0; x < w; ++x) { const at = edge + 4 * x;"
                " const off = Math.max(...[0, 1, 2].map((k) => Math.abs(p[at + k] - p[edge + k]))); if (off > 6) bits[(y * w + x) >> 3] |= 128 >> (x & 7); } }"
                " return btoa(String.fromCharCode(...bits)); })()"))
            share = overlap(self.drawn(camera), seen)
            print(f"{part}: {share:.4f}")
            self.assertGreater(share, LEAST)


if __name__ == "__main__":
    unittest.main()

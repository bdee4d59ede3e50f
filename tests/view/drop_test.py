# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of one's own dropped into the page of `doorforge serve`: what comes out is `doorforge compose`'s byte by byte, and what is
too large, damaged or no mesh is refused by its name while the server goes on.

usage: drop_test.py BUILD"""
import concurrent.futures
import gzip
import hashlib
import json
import pathlib
import shlex
import struct
import subprocess
import unittest

import numpy as np

from pages import BUILD
from served import ServedTest, files_of, members_of

BODY = "interior_flush_01"
GIB = 1 << 30


def box(low: tuple, high: tuple) -> list:
    """Twelve triangles, outwards."""
    corners = [tuple((low, high)[bit >> (2 - k) & 1][k] for k in range(3)) for bit in range(8)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [(corners[a], corners[b], corners[c]) for a, b, c, d in faces] + [(corners[a], corners[c], corners[d]) for a, b, c, d in faces]


def swapped(triangles: list, order: tuple) -> list:
    return [tuple(tuple(sign * corner[axis] for axis, sign in order) for corner in triangle) for triangle in triangles]


LEVER = box((-9, -9, 0), (9, 9, 45)) + box((-12, -9, 45), (60, 9, 60))  # [mm] y up, z out of the door, back at z = 0


def stl(triangles: list, count: int | None = None) -> bytes:
    return bytes(80) + struct.pack("<I", len(triangles) if count is None else count) + b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles)


def obj(triangles: list, material: str = "") -> bytes:
    lines = [f"mtllib {material}\nusemtl brass"] if material else []
    lines += [f"v {x} {y} {z}" for triangle in triangles for x, y, z in triangle]
    return "\n".join(lines + [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(len(triangles))]).encode() + b"\n"


def glb(triangles: list) -> bytes:
    """[m], as glTF has it."""
    data = b"".join(struct.pack("<3f", *(0.001 * x for x in corner)) for triangle in triangles for corner in triangle)
    corners = [corner for triangle in triangles for corner in triangle]
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(corners), "type": "VEC3",
                               "min": [0.001 * min(c[k] for c in corners) for k in range(3)], "max": [0.001 * max(c[k] for c in corners) for k in range(3)]}],
                "bufferViews": [{"buffer": 0, "byteLength": len(data)}], "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def rotation(axis: list[float], angle: float) -> np.ndarray:
    """Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def vertices_of(text: bytes) -> np.ndarray:
    return np.array([[float(x) for x in line.split()[1:4]] for line in text.decode().splitlines() if line.startswith("v ")])


class DroppedMeshes(ServedTest):
    def file(self, name: str, content: bytes) -> pathlib.Path:
        folder = self.folder / "mine"
        folder.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
        return folder / name

    def drop(self, *paths: pathlib.Path) -> None:
        self.browser.choose_files("#file", *paths)
        self.browser.wait("document.querySelector('dialog.own[open]') !== null || document.querySelector('.actions .asked').classList.contains('refused')")

    def request_with(self, name: str, content: bytes, mesh: dict) -> str:
        """A request for a door with this handle, which is dropped past the page."""
        self.assertEqual(self.upload(name, content)[0], 200)
        return json.dumps({"body": BODY, "handle": name, "files": {name: hashlib.sha256(content).hexdigest()}, "handle_mesh": mesh})

    def compose_page(self) -> None:
        self.browser.open(self.address)
        self.settled()
        self.set("category", "interior")
        self.settled()

    def click_face(self, axis: int, value: float) -> None:
        """Clicks the face where this coordinate has this value."""
        low, high = self.browser.js(f"[doorforge.composer.offered.box.min.getComponent({axis}), doorforge.composer.offered.box.max.getComponent({axis})]")
        side = 1 if value > (low + high) / 2 else -1
        self.click_plane([side if k == axis else 0 for k in range(3)], side * value)

    def click_plane(self, normal: list[float], distance: float) -> None:
        """Clicks, with the mouse, on the middle of a triangle of the mesh's face in the plane normal * x = distance, looked at from before it."""
        self.browser.settle()  # the canvas gets its size a frame after its dialog is shown
        self.browser.js(f"""(() => {{
          const own = doorforge.composer.offered, camera = own.stage.camera, far = camera.position.length();
          camera.position.set({normal}[0], {normal}[1], {normal}[2]).multiplyScalar(far).addScalar(0.01);
          own.stage.controls.target.set(0, 0, 0); own.stage.controls.update(); own.stage.draw();
        }})()""")
        x, y = self.browser.js(f"""(() => {{
          const own = doorforge.composer.offered, mesh = own.meshes[0], p = mesh.positions, n = {normal};
          for (let k = 0; k < mesh.indices.length; k += 3) {{
            const places = [0, 1, 2].map((i) => 3 * mesh.indices[k + i]);
            if (!places.every((at) => Math.abs(n[0] * p[at] + n[1] * p[at + 1] + n[2] * p[at + 2] - {distance}) < 1e-2 * own.unit)) continue;
            const corners = places.map((at) => own.drawn[0].localToWorld(own.box.min.clone().fromArray(p, at)));
            const middle = corners[0].add(corners[1]).add(corners[2]).divideScalar(3).project(own.stage.camera);
            const b = own.canvas.getBoundingClientRect();
            return [b.x + (middle.x + 1) / 2 * b.width, b.y + (1 - middle.y) / 2 * b.height];
          }}
        }})()""")
        self.browser.click(x, y)

    def put_on(self) -> None:
        self.browser.click_on("#own-apply")
        self.settled()

    def downloaded(self) -> dict[str, bytes]:
        self.browser.js("doorforge.composer.download()")
        return members_of(bytes(self.browser.js("[...doorforge.composer.downloaded]")))

    def by_command_line(self, arguments: list[str], folder: str) -> dict[str, bytes]:
        """The files of `doorforge compose` run beside the user's own; errors that `validate` finds are no matter here."""
        there = self.folder / folder
        there.mkdir()
        for path in (self.folder / "mine").iterdir():
            (there / path.name).write_bytes(path.read_bytes())
        result = subprocess.run([BUILD / "bin/doorforge", *arguments], cwd=there, capture_output=True, text=True, timeout=300, check=False)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return files_of(there / "doors/mine")

    def check_equal(self, name: str, role: str = "handle") -> None:
        got = self.downloaded()
        self.assertIn(f"{role}/part.json", got)
        self.assertIn("validation.json", got)
        command = shlex.split(self.browser.js("document.querySelector('.command code').textContent"))
        self.assertEqual(self.by_command_line(command[1:], f"{name}_command"), got)
        yaml = self.browser.js("doorforge.composer.copyYaml.text")
        (self.folder / "mine/door.yaml").write_text(yaml)
        command = shlex.split(yaml.splitlines()[0].removeprefix("#"))
        self.assertEqual(self.by_command_line(command[1:], f"{name}_yaml"), got)

    def test_a_lever_whose_back_is_clicked_is_compose_s_folder(self) -> None:
        self.compose_page()
        self.drop(self.file("my_lever.stl", stl(LEVER)))
        self.click_face(2, 0)
        self.assertEqual(self.browser.js("[doorforge.composer.offered.front, doorforge.composer.offered.mesh.mount]"), ["z", [0, 0, 0]])
        self.set("own-up", "y")
        self.set("own-mechanism", "lever")
        self.set("own-license", "CC0-1.0")
        self.put_on()
        self.set("hinge_side", "right")
        self.set("latch", "bolt")
        self.set("lock_effort_nm", 75)
        self.set("license_allow", "CC0-1.0, MIT")
        self.settled()
        self.assertEqual(self.browser.js("doorforge.view.record.mechanism"), "lever")
        self.assertIn("--handle-front=z", self.browser.js("document.querySelector('.command code').textContent"))
        self.assertIn("mm along the door", self.browser.js("document.querySelector('.notes').textContent"))
        self.check_equal("stl")
        self.browser.js("doorforge.composer.open()")
        self.browser.wait("document.querySelector('dialog[open]') !== null && !doorforge.composer.film.playing")
        self.assertEqual(self.browser.js("document.querySelector('dialog[open] .chip').textContent"), "Opened")
        self.assertEqual(self.browser.errors, [])

    def test_an_obj_that_lies_otherwise_brings_its_material(self) -> None:
        self.compose_page()
        lying = swapped(LEVER, ((0, 1), (2, -1), (1, 1)))  # out of the door is -y, up is z
        self.drop(self.file("brass lever.obj", obj(lying, "brass.mtl")), self.file("brass.mtl", b"newmtl brass\nKd 0.8 0.6 0.2\n"))
        self.click_face(1, 0)
        self.assertEqual(self.browser.js("doorforge.composer.offered.front"), "-y")
        self.set("own-up", "z")
        self.set("own-mechanism", "lever")
        self.put_on()
        self.assertIn("'brass lever.obj'", self.browser.js("document.querySelector('.command code').textContent"))
        self.check_equal("obj")

    def test_a_lever_that_lies_skew_is_put_on_by_two_clicks(self) -> None:
        """Its back and its top are clicked; it comes out as one that lies along the axes, as far as positions on the screen tell."""
        turn = rotation([1, -2, 0.5], 1.1)
        turned = [tuple(tuple(turn @ corner) for corner in triangle) for triangle in LEVER]
        self.compose_page()
        self.drop(self.file("skew.stl", stl(turned)))
        self.click_plane(list(-turn[:, 2]), 0)
        self.browser.js("(() => { const c = document.getElementById('own-click'); c.value = 'up'; c.dispatchEvent(new Event('change')); })()")
        self.click_plane(list(turn[:, 1]), 9)
        front, up = (np.array([float(x) for x in self.browser.js(f"doorforge.composer.offered.{key}").split(",")]) for key in ("front", "up"))
        np.testing.assert_allclose(front, turn[:, 2], atol=1e-4)
        np.testing.assert_allclose(up, turn[:, 1], atol=1e-4)
        self.assertEqual(self.browser.js("[document.getElementById('own-front').value, document.getElementById('own-front_xyz').value]"), ["skew", self.browser.js("doorforge.composer.offered.front")])
        self.set("own-mechanism", "lever")
        self.put_on()
        skew = self.downloaded()
        self.check_equal("skew")
        _, archive = self.ask("POST", "/download", self.request_with("straight.stl", stl(LEVER), {"front": "z", "up": "y", "mount": [0, 0, 0], "mechanism": "lever"}))
        straight = members_of(archive)
        grip = next(name for name in straight if name.startswith("handle/") and name.endswith("grip.obj"))
        found, expected = vertices_of(skew[grip]), vertices_of(straight[grip])
        self.assertEqual(found.shape, expected.shape)
        apart = np.linalg.norm(found[:, None] - expected, axis=2)
        self.assertLess(max(apart.min(axis=0).max(), apart.min(axis=1).max()), 5e-6)

    def test_a_direction_may_be_typed(self) -> None:
        self.compose_page()
        self.drop(self.file("typed.stl", stl(LEVER)))
        self.set("own-front", "skew")
        self.set("own-front_xyz", "0,0.1,")  # no direction yet
        self.assertEqual(self.browser.js("doorforge.composer.offered.front"), "1,0,0")
        self.set("own-front_xyz", "0,0.1,1")
        self.assertEqual(self.browser.js("[doorforge.composer.offered.front, doorforge.composer.offered.up]"), ["0,0.1,1", "y"])
        self.set("own-mechanism", "lever")
        self.put_on()
        self.assertIn("--handle-front=0,0.1,1", self.browser.js("document.querySelector('.command code').textContent").replace("'", ""))

    def test_a_mount_beside_the_mesh_is_told(self) -> None:
        self.compose_page()
        self.drop(self.file("mounted.stl", stl(LEVER)))
        said = "[document.querySelector('dialog.own .asked').textContent, document.querySelector('dialog.own .asked').classList.contains('refused')]"
        self.set("own-mount_x", "300")
        self.assertEqual(self.browser.js("doorforge.composer.offered.mesh.mount"), [300, 0, 0])
        self.assertEqual(self.browser.js(said), ["This point lies beside the mesh: the handle would turn about an axis outside of it.", True])
        self.set("own-mount_x", "30")
        self.assertEqual(self.browser.js(said), ["", False])
        self.assertEqual(self.browser.js("doorforge.composer.offered.mountPoint.toArray().map((x) => x / doorforge.composer.offered.unit)"), [30, 0, 0])

    def test_a_glb_stands_as_its_format_says(self) -> None:
        self.compose_page()
        self.drop(self.file("my_lever.glb", glb(LEVER)))
        self.assertEqual(self.browser.js("[doorforge.composer.offered.front, doorforge.composer.offered.up]"), ["z", "y"])
        self.set("own-mechanism", "lever")
        self.put_on()
        self.assertEqual(self.browser.js("Object.keys(JSON.parse(doorforge.composer.request).handle_mesh)"), ["mechanism"])
        self.check_equal("glb")

    def test_a_leaf_is_put_behind_a_handle(self) -> None:
        self.compose_page()
        self.drop(self.file("my_leaf.stl", stl(box((0, 0, 0), (40, 800, 1900)))))
        self.set("own-role", "body")
        self.click_face(0, 40)
        self.assertEqual(self.browser.js("[doorforge.composer.offered.front, doorforge.composer.offered.mesh.mount]"), ["x", []])
        self.set("own-hinge", "right")
        self.put_on()
        self.assertIn("--body my_leaf.stl", self.browser.js("document.querySelector('.command code').textContent"))
        self.check_equal("leaf", "body")

    def test_a_leaf_and_a_handle_of_one_s_own_make_a_door(self) -> None:
        self.compose_page()
        self.drop(self.file("own_leaf.stl", stl(box((0, 0, 0), (40, 800, 1900)))))
        self.set("own-role", "body")
        self.click_face(0, 40)
        self.put_on()
        self.drop(self.file("own_lever.stl", stl(LEVER)))
        self.click_face(2, 0)
        self.set("own-up", "y")
        self.set("own-mechanism", "lever")
        self.put_on()
        command = self.browser.js("document.querySelector('.command code').textContent")
        for word in ("--body own_leaf.stl", "--handle own_lever.stl", "--category interior"):
            self.assertIn(word, command)
        self.check_equal("both")
        self.assertIn("body/part.json", self.downloaded())
        # what is changed and cancelled counts for nothing
        before = self.browser.js("doorforge.composer.request")
        self.browser.click_on("#own-row-handle .own-edit")
        self.set("own-up", "x")
        self.browser.key("Escape")
        self.browser.wait("document.querySelector('dialog[open]') === null")
        self.assertEqual(self.browser.js("doorforge.composer.request"), before)
        self.browser.click_on("#own-row-body .own-remove")
        self.settled()
        command = self.browser.js("document.querySelector('.command code').textContent")
        self.assertNotIn("own_leaf.stl", command)
        self.assertIn("own_lever.stl", command)

    def test_a_rose_in_a_file_of_its_own_stays_fixed(self) -> None:
        rose = self.file("ring.stl", stl(box((-26, -26, 0), (26, 26, 8))))
        grip = self.file("rosed.stl", stl(LEVER))
        self.compose_page()
        self.drop(rose, grip)
        self.set("own-which", "rosed.stl")
        self.browser.wait("doorforge.composer.offered.name === 'rosed.stl'")
        self.set("own-beside", "ring.stl")
        self.assertEqual(self.browser.js("doorforge.composer.offered.fixed.map(({ geometry }) => geometry.attributes.position.count)"), [36])  # it is drawn with it
        self.click_face(2, 0)
        self.set("own-up", "y")
        self.set("own-mechanism", "lever")
        self.put_on()
        self.assertIn("--handle-rose=ring.stl", self.browser.js("document.querySelector('.command code').textContent"))
        got = self.downloaded()
        self.assertEqual([piece["name"] for piece in json.loads(got["handle/part.json"])["pieces"]], ["rose", "grip"])
        self.assertEqual(self.browser.js("document.querySelector('#own-row-handle .name').textContent"), "handle: rosed.stl, with ring.stl")
        self.assertTrue(self.browser.js("document.querySelector('dialog.own') === null"), "nothing is left to ask")
        self.check_equal("rose")

    def test_a_frame_in_a_file_of_its_own_stands(self) -> None:
        leaf = self.file("framed.stl", stl(box((0, 0, 0), (40, 800, 1900))))
        frame = self.file("posts.stl", stl(box((0, -60, 0), (40, -3, 1960)) + box((0, 803, 0), (40, 860, 1960))))
        self.compose_page()
        self.drop(leaf, frame)
        self.set("own-role", "body")
        self.set("own-beside", "posts.stl")
        self.assertEqual(self.browser.js("document.querySelector('label[for=own-beside]').textContent"), "Its frame")
        self.put_on()
        self.assertIn("--body-frame=posts.stl", self.browser.js("document.querySelector('.command code').textContent"))
        self.assertEqual({piece["name"] for piece in json.loads(self.downloaded()["body/part.json"])["pieces"]}, {"frame", "leaf"})
        self.check_equal("frame", "body")

    def tab_to(self, field: str) -> None:
        """Goes there by the key Tab, as who has no mouse."""
        for _ in range(40):
            if self.browser.js("document.activeElement.id") == field:
                return
            self.browser.key("Tab")
        self.fail(f"{field} is not reached by Tab")

    def choose_by_key(self, field: str, value: str) -> None:
        self.tab_to(field)
        for _ in range(9):
            if self.browser.js("document.activeElement.value") == value:
                return
            self.browser.key("ArrowDown")
        self.fail(f"{field} has no {value}")

    def test_a_leaf_and_a_handle_dropped_at_once_come_one_after_the_other_by_keyboard_alone(self) -> None:
        self.compose_page()
        self.drop(self.file("plank.stl", stl(box((0, 0, 0), (40, 800, 1900)))), self.file("grip.stl", stl(LEVER)))
        self.assertIn("After this one: grip.stl", self.browser.js("document.querySelector('dialog.own').textContent"))
        self.choose_by_key("own-role", "body")
        self.tab_to("own-apply")
        self.browser.key("Enter")
        self.browser.wait("document.querySelector('dialog.own[open] h1')?.textContent === 'grip.stl'")
        self.assertEqual(self.browser.js("[document.querySelectorAll('dialog.own').length, doorforge.composer.offered.role]"), [1, "handle"])
        self.choose_by_key("own-mechanism", "lever")
        self.choose_by_key("own-front", "z")
        self.tab_to("own-apply")
        self.browser.key("Enter")
        self.browser.wait("document.querySelector('dialog.own') === null")
        self.settled()
        self.assertEqual(self.browser.js("[...document.querySelectorAll('.own-row .name')].map((n) => n.textContent)"), ["leaf: plank.stl", "handle: grip.stl"])
        command = self.browser.js("document.querySelector('.command code').textContent")
        for word in ("--body plank.stl", "--handle grip.stl", "--handle-front=z"):
            self.assertIn(word, command)
        self.check_equal("at_once")

    def test_two_files_of_one_name_on_one_door_are_refused(self) -> None:
        self.compose_page()
        self.drop(self.file("same.stl", stl(LEVER)))
        self.set("own-front", "z")
        self.put_on()
        self.drop(self.file("same.stl", stl(box((0, 0, 0), (40, 800, 1900)))))
        self.set("own-role", "body")
        self.browser.click_on("#own-apply")
        self.browser.wait("document.querySelector('.actions .asked').classList.contains('refused')")
        self.assertIn("same.stl: another file of this name", self.browser.js("document.querySelector('.actions .asked').textContent"))
        self.assertIn("--handle same.stl", self.browser.js("document.querySelector('.command code').textContent"))

    def test_every_setting_of_compose_has_its_field(self) -> None:
        self.compose_page()
        self.assertEqual(self.browser.js("Object.keys(doorforge.document.settings).filter((key) => document.getElementById(key) === null)"), [])
        self.assertEqual(self.browser.js("Object.keys(doorforge.document.settings).length"), 27)

    def test_a_dropped_mesh_can_be_removed_and_by_keyboard_alone_be_turned(self) -> None:
        self.compose_page()
        self.drop(self.file("plate.stl", stl(LEVER)))
        self.browser.js("document.getElementById('own-front').focus()")
        for _ in range(3):
            self.browser.key("ArrowDown")
        self.assertEqual(self.browser.js("doorforge.composer.offered.mesh.front"), "z")
        self.put_on()
        self.assertIn("plate.stl", self.browser.js("document.querySelector('.command code').textContent"))
        self.browser.click_on("#own-row-handle .own-remove")
        self.settled()
        self.assertNotIn("plate.stl", self.browser.js("document.querySelector('.command code').textContent"))

    def test_a_drag_is_a_drop(self) -> None:
        self.compose_page()
        path = self.file("dragged.stl", stl(LEVER))
        for kind in ("dragEnter", "dragOver", "drop"):
            self.browser.call("Input.dispatchDragEvent", type=kind, x=100, y=150, data={"items": [], "files": [str(path)], "dragOperationsMask": 1})
        self.browser.wait("document.querySelector('dialog.own[open]') !== null")
        self.assertEqual(self.browser.js("doorforge.composer.offered.name"), "dragged.stl")

    def test_two_gigabytes_are_refused_by_name(self) -> None:
        self.compose_page()
        huge = self.folder / "huge.stl"
        with huge.open("wb") as sparse:
            sparse.truncate(2 * GIB)
        self.drop(huge)
        said = self.browser.js("document.querySelector('.actions .asked').textContent")
        self.assertIn("huge.stl: has 2048 MiB", said)
        # past the page: announced
        answer = self.ask_raw(f"POST /file?name=huge.stl HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nContent-Type: application/octet-stream\r\nContent-Length: {2 * GIB}\r\n\r\n")
        self.assertIn(b"413", answer.splitlines()[0])
        self.assertIn(b"huge.stl: has 2048 MiB", answer)
        self.assertEqual(self.ask("GET", "/")[0], 200)

    def upload(self, name: str, content: bytes, **headers: str) -> tuple[int, str]:
        code, answer = self.ask("POST", f"/file?name={name}", content, **({"Content_Type": "application/octet-stream"} | headers))
        return code, "" if code == 200 else json.loads(answer)["error"]

    def test_bombs_are_refused_by_name(self) -> None:
        deep = b"[" * 200_000
        nested = struct.pack("<III", 0x46546C67, 2, 20 + len(deep)) + struct.pack("<II", len(deep), 0x4E4F534A) + deep
        claims = glb(LEVER).replace(b'"count": 72', b'"count": 4000000000')
        many = stl([((0, 0, 0), (1, 0, 0), (0, 1, 0))] * 1_050_000)
        for name, content in (("claims.stl", stl(LEVER, 4_000_000_000)), ("nested.glb", nested), ("claims.glb", claims), ("many.stl", many),
                              ("text.obj", b"no mesh"), ("empty.stl", b""), ("points.obj", b"v 1e308 nan inf\n" * 1000 + b"f 1 2 3\n")):
            code, said = self.upload(name, content)
            self.assertEqual(code, 400, (name, said))
            self.assertIn(name, said)
            self.assertNotIn("/doorforge-composer", said)
            self.assertEqual(self.ask("GET", "/")[0], 200)

    def test_compressed_bodies_are_not_unpacked(self) -> None:
        for encoding in ("gzip", "br", "deflate"):
            self.assertEqual(self.upload("a.stl", gzip.compress(bytes(50 << 20)), Content_Encoding=encoding)[0], 415)
        self.assertEqual(self.ask("POST", "/compose", gzip.compress(b" " * (50 << 20)), Content_Encoding="gzip")[0], 415)
        chunked = self.ask_raw(f"POST /file?name=a.stl HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nContent-Type: application/octet-stream\r\nTransfer-Encoding: chunked\r\n\r\n")
        self.assertIn(b"415", chunked.splitlines()[0])  # no length

    def test_names_that_are_none_are_refused(self) -> None:
        good = stl(LEVER)
        for name in ("..%2Fa.stl", "..", "%2Fetc%2Fpasswd", ".hidden.stl", "a%2Fb.stl", "a%5Cb.stl", "a*.stl", "a%0A.stl", "-a.stl", "a.exe", "a", "", "x" * 200 + ".stl", "a.stl%00.glb"):
            self.assertEqual(self.upload(name, good)[0], 400, name)
        self.assertEqual(self.upload("a.stl", good)[0], 200)
        digest = hashlib.sha256(good).hexdigest()
        request = {"body": BODY, "handle": "a.stl", "files": {"a.stl": digest}, "handle_mesh": {"front": "z", "up": "y"}}
        self.assertEqual(self.ask("POST", "/compose", json.dumps(request))[0], 200)
        for change, code in (({"handle": "../a.stl", "files": {"../a.stl": digest}}, 400), ({"files": {"/elsewhere/a.stl": digest}}, 400), ({"files": {"a.stl": "../../etc/passwd"}}, 404),
                             ({"files": {"a.stl": 3}}, 400), ({"files": [digest]}, 400), ({"files": {}}, 404), ({"handle": "/etc/passwd"}, 404), ({"files": {f"{i}.stl": digest for i in range(17)}}, 400),
                             ({"handle_mesh": {"rose": "/etc/passwd"}}, 400), ({"body_mesh": {"frame": "../x.stl"}}, 400), ({"handle_mesh": {"rose": "b.stl"}}, 400), ({"handle_mesh": {"front": "q"}}, 400)):
            status, said = self.ask("POST", "/compose", json.dumps(request | change))
            self.assertEqual(status, code, (change, said))
            self.assertNotIn(b"/doorforge-composer", said)

    def test_an_obj_names_no_file_elsewhere(self) -> None:
        """A material file outside is not read: the mesh is, without it."""
        secret = self.folder / "secret.mtl"
        secret.write_text("newmtl brass\nKd 1 0 0\n")
        for material, red in ((str(secret), False), ("../secret.mtl", False), ("beside.mtl", True)):
            mesh = obj(LEVER, material)
            files = {"a.obj": mesh, "beside.mtl": secret.read_bytes()}
            for name, content in files.items():
                self.assertEqual(self.upload(name, content)[0], 200)
            request = {"body": BODY, "handle": "a.obj", "handle_mesh": {"front": "z", "up": "y"}, "files": {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}}
            code, archive = self.ask("POST", "/download", json.dumps(request))
            self.assertEqual(code, 200)
            materials = [text for name, text in members_of(archive).items() if name.startswith("handle/") and name.endswith(".mtl")]
            self.assertEqual(any(b"Kd 1 0 0" in text for text in materials), red, (material, materials))

    def test_two_tabs_drop_files_of_one_name(self) -> None:
        def composed(mesh: bytes) -> bytes:
            self.assertEqual(self.upload("a.stl", mesh)[0], 200)
            request = {"body": BODY, "handle": "a.stl", "handle_mesh": {"front": "z", "up": "y"}, "files": {"a.stl": hashlib.sha256(mesh).hexdigest()}}
            code, archive = self.ask("POST", "/download", json.dumps(request))
            self.assertEqual(code, 200)
            return archive
        meshes = [stl(LEVER), stl(box((-9, -9, 0), (9, 9, 45)) + box((-12, -9, 45), (50, 9, 60)))]
        alone = [composed(mesh) for mesh in meshes]
        self.assertNotEqual(*alone)
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            self.assertEqual(list(pool.map(composed, meshes * 4)), alone * 4)

    def test_files_that_were_long_not_asked_for_are_forgotten(self) -> None:
        mesh = stl(LEVER)
        self.assertEqual(self.upload("a.stl", mesh)[0], 200)
        request = json.dumps({"body": BODY, "handle": "a.stl", "handle_mesh": {"front": "z", "up": "y"}, "files": {"a.stl": hashlib.sha256(mesh).hexdigest()}})
        self.assertEqual(self.ask("POST", "/compose", request)[0], 200)
        for number in range(5):  # 300 MiB
            self.assertEqual(self.upload(f"{number}.png", bytes([number]) * (60 << 20))[0], 200)
        code, said = self.ask("POST", "/compose", request)
        self.assertEqual(code, 404)
        self.assertIn(b"a.stl: is no longer kept; drop it again", said)
        self.assertEqual(self.upload("a.stl", mesh)[0], 200)
        self.assertEqual(self.ask("POST", "/compose", request)[0], 200)

    def test_foreign_pages_may_not_drop(self) -> None:
        for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}, {"Sec_Fetch_Site": "cross-site"}):
            self.assertEqual(self.upload("a.stl", stl(LEVER), **headers)[0], 403)
        self.assertEqual(self.upload("a.stl", stl(LEVER), Content_Type="multipart/form-data")[0], 415)

    def test_small_screen(self) -> None:
        self.compose_page()
        self.browser.size(390, 844, mobile=True)
        self.drop(self.file("small.stl", stl(LEVER)))
        self.assertLessEqual(self.browser.js("document.documentElement.scrollWidth"), 390)
        self.assertLessEqual(self.browser.js("document.querySelector('dialog.own').scrollWidth"), 390)


if __name__ == "__main__":
    unittest.main()

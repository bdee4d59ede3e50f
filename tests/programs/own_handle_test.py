# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A user's own handle on a body of the catalogue, in one command."""
import json
import pathlib
import struct
import unittest
import zlib
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


MAGENTA = {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 1, 1]}}


def write_glb(path: pathlib.Path, facets: list, node: dict | None = None) -> None:
    """One magenta mesh in one node of a binary glTF 2.0, without indices."""
    points = np.array(facets, dtype="<f4").reshape(-1, 3)
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "my lever", "mesh": 0} | (node or {})],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "materials": [MAGENTA],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                       "min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}],
        "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}],
        "buffers": [{"byteLength": points.nbytes}],
    }
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", points.nbytes, b"BIN\0") + points.tobytes()
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def write_dae(path: pathlib.Path, facets: list, asset: str) -> None:
    """One COLLADA 1.4.1 mesh; `asset` is what its <asset> holds."""
    numbers = np.array(facets, dtype=float).reshape(-1, 3)
    text = " ".join(f"{number:.9g}" for number in numbers.ravel())
    indices = " ".join(map(str, range(len(numbers))))
    path.write_text(f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>{asset}</asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{numbers.size}">{text}</float_array><technique_common>
<accessor source="#a" count="{len(numbers)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(facets)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""")


def turned(facets: list, rows: list) -> list:
    """The same facets in axes whose `rows` are given in the axes along the door, up, out of it."""
    return (np.array(facets, dtype=float) @ np.array(rows, dtype=float).T).tolist()


def read_png(path: pathlib.Path) -> np.ndarray:
    """Height x width x 3 of an 8-bit RGB PNG without interlacing."""
    content = path.read_bytes()
    width, height, depth, kind = struct.unpack(">IIBB", content[16:26])
    assert (depth, kind) == (8, 2), "not 8-bit RGB"
    packed, at = b"", 8
    while at < len(content):
        size, name = struct.unpack(">I4s", content[at:at + 8])
        packed += content[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += size + 12
    rows = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(height, 1 + 3 * width)
    image = np.zeros((height + 1, width + 1, 3), dtype=int)  # a black row above, a black column before
    for y, row in enumerate(rows, 1):
        for x in range(1, width + 1):
            left, above, corner = image[y, x - 1], image[y - 1, x], image[y - 1, x - 1]
            to_left, to_above = abs(above - corner), abs(left - corner)
            to_corner = abs(left + above - 2 * corner)
            paeth = np.where((to_left <= to_above) & (to_left <= to_corner), left,
                             np.where(to_above <= to_corner, above, corner))
            guess = (0, left, above, (left + above) // 2, paeth)[row[0]]
            image[y, x] = (row[3 * x - 2:3 * x + 1] + guess) % 256
    return image[1:, 1:]


def extent(mask: np.ndarray) -> np.ndarray:
    """Columns and rows that a mask spans."""
    rows, columns = np.nonzero(mask)
    return np.array([np.ptp(columns) + 1, np.ptp(rows) + 1])


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
        return self.compose_as_stated(mesh, *self.AXES, *more)

    def compose_as_stated(self, mesh: pathlib.Path, *more: str, out: pathlib.Path | None = None):
        return run("compose", *self.BODY, "--handle", mesh, "--handle-mechanism", "lever", "--out", out or self.out,
                   *more)

    def grip_of(self, out: pathlib.Path) -> np.ndarray:
        return vertices_of(out / "meshes/visual/grip.obj")

    def assert_stands_right(self, out: pathlib.Path, name: str) -> None:
        """68.75 mm out of the door, 162.5 along it towards the hinge, 22.5 up; its neck on the leaf and its axis."""
        grip = self.grip_of(out)
        np.testing.assert_allclose(np.ptp(grip, axis=0), [0.06875, 0.1625, 0.0225], atol=3e-6, err_msg=name)
        np.testing.assert_allclose(grip[:, 1].min(), -0.15, atol=3e-6, err_msg=name)
        joint = joint_of(out / "model.urdf", "handle_joint")
        leaf = vertices_of(out / "meshes/visual/leaf.obj")
        self.assertAlmostEqual(joint["origin"][0] + grip[:, 0].min(), leaf[:, 0].max(), delta=0.002, msg=name)

    def assert_nothing_left(self) -> None:
        left = [path.name for path in self.folder.rglob("*") if path.is_dir() and path.name != "doors"]
        self.assertEqual(left, [])

    def test_one_command_makes_a_validated_pictured_door_that_opens(self):
        mesh = self.folder / "my_lever.stl"
        write_stl(mesh, lever_facets())
        result = self.compose(mesh, "--preview")
        self.assert_ends(result, 0)
        self.assertIn("read in mm", result.stderr)
        self.assertIn("validated: 0 errors, 1 warning\n", result.stdout)  # nobody said its licence
        self.assertIn("1 door composed", result.stdout)
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

    def test_axes_and_unit_are_those_of_the_format(self):
        lever = lever_facets(0.001)
        write_glb(self.folder / "lever.glb", lever)
        # what COLLADA's specification says of each axis that may point up: which one points right and which at you
        axes = {"Y_UP": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
                "Z_UP": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
                "X_UP": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]}
        for name, rows in axes.items():
            write_dae(self.folder / f"{name}.dae", turned(lever_facets(0.1), rows),
                      f'<unit name="cm" meter="0.01"/><up_axis>{name}</up_axis>')
        # left out, y is up and the unit is the metre
        write_dae(self.folder / "silent.dae", lever, "<!-- <up_axis>Z_UP</up_axis> -->")
        words = {"lever.glb": ("y up, z out", "unit from the file: m;"),
                 "Y_UP.dae": ("y up, z out", "unit from the file: 0.01 m"),
                 "Z_UP.dae": ("z up, -y out", "unit from the file: 0.01 m"),
                 "X_UP.dae": ("x up, z out", "unit from the file: 0.01 m"),
                 "silent.dae": ("y up, z out", "unit from the file: m;")}
        for name, (axes_text, unit_text) in words.items():
            out = self.folder / "stated" / name
            result = self.compose_as_stated(self.folder / name, out=out)
            self.assert_ends(result, 0)
            self.assertIn(f"axes from the file: {axes_text} of the door; --handle-up", result.stderr, name)
            self.assertIn(unit_text, result.stderr, name)
            self.assert_stands_right(out, name)

    def test_a_unit_that_is_plainly_untrue_is_not_believed(self):
        # CAD programs write millimetres into glTF, which is in metres
        write_glb(self.folder / "cad.glb", lever_facets())
        result = self.compose_as_stated(self.folder / "cad.glb")
        self.assert_ends(result, 0)
        self.assertIn("the file's own unit would make it 162 m long; read in mm", result.stderr)
        self.assert_stands_right(self.out, "cad.glb")

    def test_flags_win_over_the_file(self):
        write_dae(self.folder / "inches.dae", turned(lever_facets(1 / 25.4), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
                  '<unit meter="0.01"/><up_axis>Z_UP</up_axis>')
        result = self.compose_as_stated(self.folder / "inches.dae", *self.AXES, "--handle-unit", "in")
        self.assert_ends(result, 0)
        self.assertNotIn("from the file", result.stderr)
        self.assert_stands_right(self.out, "inches.dae")

    def test_a_file_without_axes_says_what_was_taken(self):
        write_stl(self.folder / "plain.stl", turned(lever_facets(), [[0, 0, 1], [1, 0, 0], [0, 1, 0]]))
        result = self.compose_as_stated(self.folder / "plain.stl")
        self.assert_ends(result, 0)
        self.assertIn("axes assumed, for the file states none: z up, x out of the door; --handle-up", result.stderr)
        self.assert_stands_right(self.out, "plain.stl")

    def test_transforms_that_make_no_sense_are_refused_by_name(self):
        lever = lever_facets(0.001)
        bent = {"scale": [1, 0, 1]}, {"rotation": [0, 0, 0, 2]}, {"matrix": [0] * 15 + [1]}, {"scale": [1e300] * 3}
        for node in bent:
            write_glb(self.folder / "bent.glb", lever, node)
            result = self.compose_as_stated(self.folder / "bent.glb")
            self.assert_refused(result, 2, 3)
            self.assertIn("my lever", result.stderr, node)
            self.assertIn("export", result.stderr, node)
        write_dae(self.folder / "axis.dae", lever, "<up_axis>W_UP</up_axis>")
        result = self.compose_as_stated(self.folder / "axis.dae")
        self.assert_refused(result, 2, 3)
        self.assertIn("W_UP", result.stderr)
        for unit in ("0", "-1", "wide", "nan"):
            write_dae(self.folder / "unit.dae", lever, f'<unit meter="{unit}"/>')
            result = self.compose_as_stated(self.folder / "unit.dae")
            self.assert_refused(result, 2, 3)
            self.assertIn(f'meter="{unit}"', result.stderr)

    def test_the_close_ups_show_the_handle_to_scale(self):
        write_glb(self.folder / "lever.glb", lever_facets(0.001))
        self.assert_ends(self.compose_as_stated(self.folder / "lever.glb"), 0)
        width, height = 240, 180
        for focus, tiles in {"handle": 3, "all": 4, "whole": 0}.items():
            png = self.folder / f"{focus}.png"
            self.assert_ends(run("preview", self.out / "handle", "--focus", focus, "--width", width, "--out", png), 0)
            size = struct.unpack(">II", png.read_bytes()[16:24])
            columns, rows = {3: (3, 1), 4: (2, 2)}.get(tiles, (0, 0))
            if not tiles:
                self.assertEqual(size, (width, height), focus)
                continue
            self.assertEqual(size[0], columns * (width + 10) + 10, focus)
            caption, rest = divmod(size[1] - 10 - rows * height, rows)  # of one line, or of more
            self.assertEqual(rest, 0, focus)
            self.assertIn(caption, (36, 52, 68), focus)
        sheet = read_png(self.folder / "handle.png")
        # along the picture and up it, in mm
        for tile, size in enumerate([(162.5, 22.5), (68.75, 22.5), (162.5, 68.75)]):
            left = 10 + tile * (width + 10)
            image = sheet[10:10 + height, left:left + width]
            red, green, blue = np.moveaxis(image, 2, 0)
            handle = extent((red > green + 60) & (blue > green + 60))
            # the ends of the bar are black
            bar = extent(image.max(axis=2) < 60)[0]
            np.testing.assert_allclose(handle * 50 / bar, size, rtol=0.05, atol=2.5, err_msg=str(tile))
            # its axes: green to the right and blue up, red to the right, green to the right and red down
            across, along = {0: (blue, green), 1: (blue, red), 2: (red, green)}[tile]
            for color, axis in ((along, 0), (across, 1)):
                others = image.sum(axis=2) - color
                arm = extent((color > 120) & (2 * others < color))
                self.assertGreater(arm[axis], 2 * arm[1 - axis], (tile, axis))
        # a whole door has the handle beside it, many doors only where it is asked for
        self.assert_ends(run("preview", self.out, "--width", "160", "--out", self.folder / "door.png"), 0)
        width, height = struct.unpack(">II", (self.folder / "door.png").read_bytes()[16:24])
        self.assertEqual(width, 2 * (160 + 10) + 10)
        self.assertIn(height - 10, [2 * (120 + 36 + 16 * more_lines) for more_lines in range(4)])

    def test_a_lever_on_its_side_is_noticed(self):
        write_glb(self.folder / "lever.glb", lever_facets(0.001))
        # what was assumed of every file once: the bar stands out of the door
        result = self.compose_as_stated(self.folder / "lever.glb", "--handle-up", "z", "--handle-front", "x")
        self.assert_ends(result, 0, 1)
        self.assertIn("HND009", result.stderr)
        self.assertIn("HND011", result.stderr)
        self.assertIn("--handle-front", result.stderr)


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""`doorforge validate --format html` in a real Chromium: each finding at its place on the object, by mouse and by keys.

usage: findings_page_test.py BUILD"""
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "programs"))
import foreign_samples as samples  # noqa: E402
from browser import Browser  # noqa: E402
from pages import PageTest, run  # noqa: E402

MOST_BYTES = 1_500_000
FACES = samples.OBJ.splitlines()


class FindingsPage(PageTest):
    def validated(self, *paths: pathlib.Path, code: int) -> pathlib.Path:
        page = self.folder / "findings.html"
        run("validate", *paths, "--ask", "none", "--format", "html", "--out", page, code=code)
        self.browser.open(page.as_uri())
        return page

    def write(self, name: str, content: str | bytes) -> pathlib.Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def gate(self, name: str, *changes: tuple[str, str]) -> pathlib.Path:
        self.write(f"{name}/meshes/box.obj", samples.OBJ)
        self.write(f"{name}/meshes/box.stl", samples.STL)
        text = samples.URDF
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return self.write(f"{name}/gate.urdf", text)

    def js(self, expression: str) -> object:
        return self.browser.js(expression)

    def choose(self, code: str) -> None:
        self.js(f"document.querySelector('[data-code={code}]').click(), 0")
        self.browser.settle()

    def picked(self) -> str:
        return self.js("document.querySelector('.picked').textContent")

    def marked(self) -> list[str]:
        """Names of the links of which a shape glows."""
        return self.js("doorforge.findings.view.model.drawn.filter((m) => m.material.emissiveIntensity > 0)"
                       ".map((m) => doorforge.findings.view.item.object.links[m.userData.shape.link].name)")

    def test_a_browser_without_webgl_shows_the_list_and_says_why_there_is_no_picture(self) -> None:
        page = self.folder / "findings.html"
        run("validate", self.gate("urdf", ('mass value="20"', 'mass value="-20"')), "--ask", "none", "--format", "html", "--out", page, code=1)
        with Browser("--disable-3d-apis") as browser:
            browser.open(page.as_uri())
            self.assertIn("no WebGL", browser.js("document.querySelector('.no-webgl').textContent"))
            browser.js("document.querySelector('[data-code=INR001]').click(), 0")
            self.assertIn("-20", browser.js("document.querySelector('[data-code=INR001]').textContent"))

    def test_findings_of_link_joint_and_mass_lie_on_the_object(self) -> None:
        page = self.validated(self.gate("urdf", ('mass value="20"', 'mass value="-20"'), ('axis xyz="0 0 -1"', 'axis xyz="0 0 -2"')), code=1)
        self.assertLess(page.stat().st_size, MOST_BYTES)
        self.choose("INR001")
        self.assertIn("leaf", self.picked())
        self.assertEqual(set(self.marked()), {"leaf"})
        # the pin stands at the centre of mass: the leaf is 0.05 m off the post, its centre 0.5 m along
        pin = self.js("(() => { const m = doorforge.findings.view.model; m.root.updateMatrixWorld(true); const v = m.marks["
                      "doorforge.findings.view.item.findings.findIndex((f) => f.code === 'INR001')].pin.matrixWorld.elements; return [v[12], v[13], v[14]]; })()")
        np.testing.assert_allclose(pin, [0, 0.55, 0], atol=1e-6)
        self.choose("JNT002")
        self.assertIn("joint hinge", self.picked())
        self.assertEqual(self.js("doorforge.findings.view.model.rods.map((rod) => rod.visible)"), [True, False, False])
        self.assertEqual(self.marked(), [], "what a joint is about is its axis")

    def test_edges_of_a_hole_are_those_of_the_missing_triangle(self) -> None:
        hole = "\n".join(line for i, line in enumerate(FACES) if i != len(FACES) - 1) + "\n"
        self.validated(self.write("hole.obj", hole), code=0)
        self.choose("GEO009")
        self.assertIn("3 edges", self.picked())
        ends = np.array(self.js("[...doorforge.findings.view.model.edgeFloats(doorforge.findings.view.item.findings.find((f) => f.code === 'GEO009').mark.edges)]")).reshape(3, 2, 3)
        missing = np.array([samples.BOX_CORNERS[i] for i in samples.BOX_FACES[-1]])
        expected = {frozenset(map(tuple, (missing[i], missing[(i + 1) % 3]))) for i in range(3)}
        self.assertEqual({frozenset(map(tuple, edge)) for edge in ends}, expected)

    def test_keys_alone_walk_through_the_findings(self) -> None:
        self.validated(self.gate("keys", ('mass value="20"', 'mass value="-20"'), ('mass value="0.3"', 'mass value="-0.3"')), code=1)
        self.js("document.querySelector('.finding').focus(), 0")
        self.browser.key("Enter")
        self.browser.settle()
        self.assertEqual(self.js("document.querySelector('.finding[aria-pressed=true]').textContent[0]"), "1")
        first = self.picked()
        self.browser.key("Tab")
        self.browser.key("Enter")
        self.browser.settle()
        self.assertNotEqual(self.picked(), first)

    def test_a_pin_is_clicked_and_a_slider_moves_what_hangs_on_it(self) -> None:
        self.validated(self.gate("click", ('mass value="20"', 'mass value="-20"')), code=1)
        at = self.js("(() => { const { model, stage } = doorforge.findings.view; stage.camera.updateMatrixWorld(); const p = model.marks[0].pin.getWorldPosition(model.root.position.clone()).project(stage.camera);"
                     " const { width, height, left, top } = stage.canvas.getBoundingClientRect(); return [left + (p.x + 1) * width / 2, top + (1 - p.y) * height / 2]; })()")
        self.browser.click(*at)
        self.browser.settle()
        self.assertIn("INR001", self.picked())
        # the lever turns with the leaf: by numpy, about z by -1 rad at y = 0.05
        self.js("(() => { const s = document.getElementById('slider-hinge'); s.value = 180 / Math.PI; s.dispatchEvent(new Event('input', { bubbles: true })); })()")
        lever = self.js("(() => { const m = doorforge.findings.view.model; const i = doorforge.findings.view.item.object.links.findIndex((l) => l.name === 'lever'); const e = m.links[i].matrix.elements; return [e[12], e[13], e[14]]; })()")
        turn = np.array([[np.cos(-1), -np.sin(-1), 0], [np.sin(-1), np.cos(-1), 0], [0, 0, 1]])
        np.testing.assert_allclose(lever, np.array([0, 0.05, 0]) + turn @ [0.05, 0.9, 0], atol=1e-4)

    def test_items_of_every_kind_are_on_one_page(self) -> None:
        paths = [self.gate("many"), self.write("gate.usda", samples.USDA), self.write("bad.xml", samples.MJCF.replace('mass="20"', 'mass="-20"').replace("meshes", "many/meshes")),
                 self.write("broken.urdf", "<robot"), self.write("box.glb", samples.glb(*samples.gltf_box()))]
        run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", self.folder / "door")
        self.validated(*paths, self.folder / "door", code=1)
        names = self.js("[...document.getElementById('item').options].map((o) => o.textContent)")
        self.assertEqual(len(names), 6)
        for i in range(6):
            self.js(f"(() => {{ const s = document.getElementById('item'); s.value = {i}; s.dispatchEvent(new Event('change')); }})()")
            self.browser.settle()
            self.assertIn(names[i].rsplit(": ", 1)[0].split("/")[-1].split(".")[0].replace("door", "interior_flush_01"), self.js("document.querySelector('h1').textContent"))
        drawn = [item["object"] for item in self.js("doorforge.document.items.map(({ path, object }) => ({ path, object: object && object.shapes.length }))")]
        self.assertEqual(sorted(n or 0 for n in drawn)[:2], [0, 0], "the door is a record, and the broken file shows nothing")

    def test_too_large_a_mesh_is_drawn_coarser_and_the_page_says_so(self) -> None:
        n = 260
        points = [f"v {x / n} {y / n} {np.sin(9 * x / n) * 0.1:.6f}" for x in range(n + 1) for y in range(n + 1)]
        faces = [f"f {a} {a + n + 1} {a + n + 2} {a + 1}" for x in range(n) for y in range(n) for a in [x * (n + 1) + y + 1]]
        page = self.validated(self.write("sheet.obj", "\n".join(points + faces)), code=0)
        self.assertLess(page.stat().st_size, MOST_BYTES)
        self.assertIn("drawn coarser", self.js("document.querySelector('.panel').textContent"))


if __name__ == "__main__":
    unittest.main()

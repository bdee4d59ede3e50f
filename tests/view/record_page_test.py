# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Pages of doors and parts in a real Chromium: the latch at work, poses against numpy's, findings, keys, small screens.

usage: record_page_test.py BUILD"""
import json
import pathlib
import shutil
import unittest

import numpy as np

from kinematics import poses_of_urdf, turned
from pages import PageTest, run

MOST_BYTES, MOST_MS = 1_500_000, 1_000
UNLOCK = np.radians(29.25)  # of the lever of the test


class RecordPage(PageTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        pair = ("--body", "interior_flush_01", "--handle", "interior_lever_tube_01")
        run("compose", *pair, "--out", cls.folder / "effort")
        run("compose", *pair, "--set", "latch=bolt", "--set", "hinge_side=right", "--set", "opening=push", "--out", cls.folder / "bolt")
        run("compose", *pair, "--set", "latch=effort", "--set", "relatch=true", "--out", cls.folder / "relatch")

    def drag(self, slider: str, degrees: float) -> float:
        """What the slider shows after it was put to an angle, as by hand."""
        return self.browser.js(f"(() => {{ const s = document.getElementById('slider-{slider}'); s.value = {degrees}; "
                               "s.dispatchEvent(new Event('input', {bubbles: true})); return Number(s.value); })()")

    def chip(self) -> str:
        return self.browser.js("document.querySelector('.chip').textContent")

    def test_page_is_small_and_soon_drawn(self) -> None:
        page = self.open("effort")
        self.assertLess(page.stat().st_size, MOST_BYTES)
        drawn, spent = [], []  # by the clock, and by the processor's time of all of Chromium, which others on the machine change little
        while len(drawn) < 20 and min(drawn + spent, default=MOST_MS) >= MOST_MS:
            before = self.browser.processor_s()
            self.browser.open(page.as_uri())
            spent.append(1000 * (self.browser.processor_s() - before))
            drawn.append(float(self.browser.js("document.documentElement.dataset.ready")))
        print(f"drawn after {min(drawn):.0f} ms, {min(spent):.0f} ms of processor's time, {page.stat().st_size} bytes")
        self.assertLess(min(drawn + spent), MOST_MS)
        self.assertEqual([url for url in self.browser.requests if not url.startswith(page.as_uri())], ["data:,"] * self.browser.requests.count("data:,"))

    def test_effort_latch_holds_until_the_handle_has_turned(self) -> None:
        self.open("effort")
        before = self.browser.screenshot()
        self.assertEqual(self.drag("hinge", 40), 0)
        self.browser.settle()
        self.assertEqual(self.chip(), "Locked")
        self.assertEqual(self.browser.screenshot(), before, "a locked door moved in the picture")
        self.drag("handle", np.degrees(UNLOCK) - 0.5)
        self.assertEqual(self.drag("hinge", 40), 0)
        self.drag("handle", np.degrees(UNLOCK) + 0.5)
        self.assertEqual(self.chip(), "Free")
        self.assertAlmostEqual(self.drag("hinge", 40), 40)
        self.browser.settle()
        self.assertNotEqual(self.browser.screenshot(), before)
        self.drag("handle", 0)
        self.assertEqual(self.chip(), "Free", "it stays unlocked while it is ajar")
        self.assertAlmostEqual(self.drag("hinge", 20), 20)
        self.drag("hinge", 0)
        self.assertEqual(self.chip(), "Locked")
        self.assertEqual(self.drag("hinge", 20), 0)

    def test_relatching_effort_shuts_the_leaf_when_the_handle_returns(self) -> None:
        self.open("relatch")
        self.drag("handle", 40)
        self.assertAlmostEqual(self.drag("hinge", 30), 30)
        self.drag("handle", 0)
        self.assertEqual(self.chip(), "Locked")
        self.assertEqual(self.browser.js("doorforge.view.latch.hinge"), 0)

    def test_bolt_holds_lets_go_and_catches_again(self) -> None:
        self.open("bolt")
        record = json.loads((self.folder / "bolt/door.json").read_text())
        unlock, throw = record["latch"]["unlock_angle_rad"], record["latch"]["bolt_throw_m"]
        self.assertLess(self.drag("hinge", 40), 0.5, "no more than the play of a door in its latch")
        self.drag("hinge", 0)
        for share in (0, 0.25, 0.5):
            self.drag("handle", np.degrees(share * unlock))
            self.assertAlmostEqual(self.browser.js("doorforge.view.latch.bolt"), -throw * share, places=6)
            self.assertEqual(self.chip(), "Locked")
        self.drag("handle", np.degrees(unlock) + 0.5)
        self.assertAlmostEqual(self.browser.js("doorforge.view.latch.bolt"), -throw, places=6)
        self.assertEqual(self.chip(), "Free")
        self.assertAlmostEqual(self.drag("hinge", 40), 40)
        self.drag("handle", 0)
        self.assertAlmostEqual(self.browser.js("doorforge.view.latch.bolt"), 0, places=6, msg="it springs out")
        drawn = []
        for degrees in np.arange(6, -0.01, -0.1):  # the strike pushes it back as the door closes
            self.drag("hinge", degrees)
            drawn.append(self.browser.js("doorforge.view.latch.bolt"))
        self.assertLess(min(drawn), -0.8 * throw)
        self.assertAlmostEqual(drawn[-1], 0, places=6)
        self.assertEqual(self.chip(), "Locked")
        self.assertLess(self.drag("hinge", 40), 0.5)

    def test_poses_are_those_of_the_urdf(self) -> None:
        for door in ("effort", "bolt"):
            self.open(door)
            for hinge, handle in ((0, 0.7), (0.3, 0.6), (1.2, 0.55)):
                self.browser.js(f"doorforge.view.turnHandle({handle}), doorforge.view.moveHinge({hinge}), 0")
                shown = [np.reshape(pose, (4, 4)).T for pose in self.browser.js("doorforge.view.poses")]
                expected = poses_of_urdf(self.folder / door / "model.urdf", {"hinge": hinge, "handle_joint": handle})
                for pose, link in zip(shown, ("base", "leaf", "handle")):
                    np.testing.assert_allclose(pose, expected[link], atol=1e-6)
                drawn = self.browser.js("doorforge.view.model.links.map((link) => link.matrix.elements)")
                np.testing.assert_allclose([np.reshape(pose, (4, 4)).T for pose in drawn], shown, atol=1e-12)

    def test_findings_are_marked_on_the_object(self) -> None:
        shutil.copytree(self.folder / "effort", self.folder / "faulty")
        path = self.folder / "faulty/door.json"
        record = json.loads(path.read_text())
        record["links"][1]["mass"]["mass_kg"] = -1
        record["hinge"]["upper_rad"] = 0.1
        path.write_text(json.dumps(record))
        told = json.loads(run("validate", self.folder / "faulty", "--json", code=1).stdout)["findings"]
        self.open("faulty")
        codes = self.browser.js("[...document.querySelectorAll('.finding')].map((e) => e.dataset.code)")
        self.assertEqual(codes, [finding["code"] for finding in told])
        self.assertIn("INR001", codes)
        before = self.browser.screenshot()
        self.browser.click_on(".finding[data-code='INR001']")
        self.assertEqual(self.browser.js("doorforge.view.marked"), ["leaf"])
        self.assertNotEqual(self.browser.screenshot(), before)
        self.browser.click_on(".finding[data-code='MEC003']")
        self.assertEqual(self.browser.js("doorforge.view.marked"), ["hinge"])

    def test_a_click_names_the_piece(self) -> None:
        self.open("effort")
        self.browser.js("doorforge.view.frameHandle(), 0")
        self.browser.settle()
        x, y, width, height = self.browser.js("(() => { const b = doorforge.view.canvas.getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()")
        self.browser.click(x + width * 0.02, y + height * 0.3)
        self.assertIn("leaf", self.browser.js("document.querySelector('.picked').textContent"))
        centre = self.browser.js("(() => { const box = doorforge.view.model.boxOf(doorforge.view.model.pieces.find((p) => p.name === 'rose'));"
                                 " const c = box.getCenter(doorforge.view.stage.camera.position.clone()).project(doorforge.view.stage.camera); return [c.x, c.y]; })()")
        self.browser.click(x + (centre[0] + 1) / 2 * width, y + (1 - centre[1]) / 2 * height)
        self.assertRegex(self.browser.js("document.querySelector('.picked').textContent"), "rose|grip")

    def test_keys_turn_zoom_and_move(self) -> None:
        self.open("effort")
        self.browser.js("doorforge.view.canvas.focus(), 0")
        eye = "doorforge.view.stage.camera.position.toArray()"
        target = "doorforge.view.stage.controls.target.toArray()"
        home, middle = np.array(self.browser.js(eye)), np.array(self.browser.js(target))
        self.browser.key("ArrowRight")
        turned_eye = np.array(self.browser.js(eye))
        self.assertGreater(np.linalg.norm(turned_eye - home), 0.1)
        self.assertAlmostEqual(np.linalg.norm(turned_eye - middle), np.linalg.norm(home - middle), places=6)
        self.browser.key("+")
        self.assertAlmostEqual(np.linalg.norm(np.array(self.browser.js(eye)) - middle), 0.85 * np.linalg.norm(home - middle), places=6)
        self.browser.key("ArrowUp", modifiers=8)
        self.assertGreater(np.linalg.norm(np.array(self.browser.js(target)) - middle), 0.1)
        self.browser.key("Home")
        np.testing.assert_allclose(self.browser.js(eye), home, atol=1e-9)
        self.browser.js("document.getElementById('slider-handle').focus(), 0")
        self.browser.key("PageUp")
        self.assertAlmostEqual(float(self.browser.js("document.getElementById('slider-handle').value")), 10)
        self.browser.key("ArrowRight")
        self.assertAlmostEqual(float(self.browser.js("document.getElementById('slider-handle').value")), 11)

    def test_all_can_be_reached_by_tab(self) -> None:
        self.open("effort")
        wanted = self.browser.js("document.querySelectorAll('button, input:not(:disabled), canvas').length")
        reached = set()
        for _ in range(wanted + 5):
            self.browser.key("Tab")
            reached.add(self.browser.js("document.activeElement.outerHTML.slice(0, 200)"))
        self.assertGreaterEqual(len(reached - {self.browser.js("document.body.outerHTML.slice(0, 200)")}), wanted)

    def test_small_screen(self) -> None:
        self.open("effort")
        self.browser.size(390, 844, mobile=True)
        self.assertLessEqual(self.browser.js("document.documentElement.scrollWidth"), 390)
        self.assertGreater(self.browser.js("doorforge.view.canvas.getBoundingClientRect().height"), 300)

    def test_visual_collision_and_both_differ(self) -> None:
        self.open("effort")
        pictures = set()
        for shown in ("visual", "collision", "both"):
            self.browser.click_on(f"button[data-value='{shown}']")
            pictures.add(self.browser.screenshot())
        self.assertEqual(len(pictures), 3)
        self.browser.click_on("button[data-value='visual']")
        for marks in ("Frames", "Grasp", "Scale"):
            self.click_text(marks)
            pictures.add(self.browser.screenshot())
        self.assertEqual(len(pictures), 6)

    def test_play_opens_and_shuts_the_door(self) -> None:
        self.open("effort")
        self.browser.js("(window.most = 0, doorforge.view.play(), 0)")
        most = 0.0
        while self.browser.js("doorforge.view.playing"):
            most = max(most, self.browser.js("doorforge.view.latch.hinge"))
        self.assertGreater(most, 1)
        self.assertEqual(self.browser.js("doorforge.view.latch.hinge"), 0)
        self.assertEqual(self.chip(), "Locked")

    def test_a_damaged_door_is_shown_with_its_fault(self) -> None:
        shutil.copytree(self.folder / "effort", self.folder / "damaged")
        (self.folder / "damaged/meshes/visual/grip.obj").unlink()
        (self.folder / "damaged/meshes/visual/rose.obj").write_text("v 1 2 nonsense\n")
        leaf = self.folder / "damaged/meshes/visual/leaf.obj"
        first, _, rest = leaf.read_text().partition("\n")
        leaf.write_text("v 0.5 0.5 0.5\n" + rest)
        self.open("damaged", code=1)
        faults = self.browser.js("[...document.querySelectorAll('.fault')].map((e) => e.textContent)")
        self.assertEqual(len(faults), 3)
        self.assertTrue(any("grip.obj" in fault for fault in faults) and any("rose.obj" in fault for fault in faults))
        self.assertTrue(any("leaf.obj: is not the mesh" in fault for fault in faults))
        self.assertIn("MSH001", self.browser.js("[...document.querySelectorAll('.finding')].map((e) => e.dataset.code)"))
        self.assertAlmostEqual(self.browser.js("(doorforge.view.turnHandle(0.7), doorforge.view.moveHinge(0.5), doorforge.view.latch.hinge)"), 0.5)

    def test_what_is_no_door_is_refused(self) -> None:
        out = self.folder / "none.html"
        (self.folder / "empty").mkdir()
        (self.folder / "broken").mkdir()
        (self.folder / "broken/door.json").write_text("{")
        for path, code in (("empty", 3), ("missing", 3), ("broken", 3)):
            result = run("view", self.folder / path, "--out", out, code=code)
            self.assertIn(path, result.stderr)
            self.assertFalse(out.exists())
        out.write_text("mine")
        run("view", self.folder / "effort", "--out", out, code=2)
        self.assertEqual(out.read_text(), "mine")

    def test_names_are_no_markup(self) -> None:
        shutil.copytree(self.folder / "effort", self.folder / "markup")
        path = self.folder / "markup/door.json"
        record = json.loads(path.read_text())
        record["license"] = "<img src=x onerror=alert(1)></script>"
        path.write_text(json.dumps(record))
        self.open("markup")
        self.assertIn("<img src=x", self.browser.js("document.querySelector('.panel').textContent"))
        self.assertEqual(self.browser.js("document.images.length"), 0)

    def test_parts_have_pages(self) -> None:
        run("catalog", "build", "--category", "safe", "--out", self.folder / "parts")
        self.open("parts/safe_box_small_01", "parts/safe_dial_lever_01")
        self.assertEqual(self.browser.js("[...document.querySelectorAll('#record option')].map((o) => o.textContent)"),
                         ["safe_box_small_01", "safe_dial_lever_01"])
        self.assertAlmostEqual(self.drag("hinge", 60), 60)
        self.browser.js("(() => { const s = document.getElementById('record'); s.value = 1; s.dispatchEvent(new Event('change')); })()")
        self.assertAlmostEqual(self.drag("handle", 30), 30)
        part = json.loads((self.folder / "parts/safe_dial_lever_01/part.json").read_text())
        axis, origin = np.array(part["joint"]["axis"]), np.array(part["joint"]["origin_m"])
        expected = np.eye(4)
        expected[:3, :3] = turned(axis, np.radians(30))
        expected[:3, 3] = origin
        np.testing.assert_allclose(np.reshape(self.browser.js("doorforge.view.poses")[1], (4, 4)).T, expected, atol=1e-6)


if __name__ == "__main__":
    unittest.main()

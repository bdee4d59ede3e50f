# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Episodes in a real Chromium: a stored one against what the reader reads and numpy calculates, the expert's film.

usage: episode_page_test.py BUILD"""
import json
import unittest

import numpy as np

from kinematics import matrix, poses_of_urdf
from pages import PageTest, run


class EpisodePage(PageTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", cls.folder / "doors/a")
        run("datagen", "open", "--doors", cls.folder / "doors", "--out", cls.folder / "data", "--episodes", "2", "--seed", "3")

    def test_a_stored_episode_is_shown_as_it_was_stored(self) -> None:
        self.open("data", options=("--doors", self.folder / "doors"))
        shown = self.browser.js("doorforge.document.episodes[0]")
        index = json.loads(next(self.folder.glob("data/open/*/shard-000000.index.json")).read_text())
        tar = next(self.folder.glob("data/open/*/shard-000000.tar")).read_bytes()

        def member(name: str) -> bytes:
            place = next(m for m in index["episodes"][0]["members"] if m["name"] == name)
            return tar[place["offset"]:place["offset"] + place["size"]]

        def array(name: str, kind: str) -> np.ndarray:
            raw = member(name)
            return np.frombuffer(raw[10 + int.from_bytes(raw[8:10], "little"):], kind)

        state = array("state.npy", "<f8").reshape(-1, 14)
        meta = json.loads(member("meta.json"))
        np.testing.assert_allclose(shown["hinge"], state[:, 11])
        np.testing.assert_allclose(shown["handle"], state[:, 12])
        np.testing.assert_allclose(shown["times"], meta["decision_time_s"])
        hands = array("proprio.npy", "<f4").reshape(-1, 32)[:, 25:28]  # of the stored observation
        np.testing.assert_allclose(shown["hands"], hands, atol=1e-5)
        np.testing.assert_allclose(np.array(shown["asked"]) - shown["hands"], array("action.npy", "<f4").reshape(-1, 9)[:, :3], atol=1e-6)
        world = matrix(meta["scene"]["world_from_door"])
        for frame in (0, len(state) - 1):
            self.browser.js(f"(doorforge.view.show({frame}), 0)")
            expected = poses_of_urdf(self.folder / "doors/a/model.urdf", {"hinge": state[frame, 11], "handle_joint": state[frame, 12]})
            for pose, link in zip(self.browser.js("doorforge.view.poses"), ("base", "leaf", "handle")):
                np.testing.assert_allclose(np.reshape(pose, (4, 4)).T, world @ expected[link], atol=1e-6)
            points = np.array(self.browser.js("[...doorforge.view.points.geometry.attributes.position.array]")).reshape(-1, 3)
            cloud = array("cloud.npy", "<f4").reshape(len(state), -1, 3)[frame][::4]
            np.testing.assert_allclose(points, cloud, atol=1e-4)

    def test_the_scrubber_moves_robot_and_door(self) -> None:
        self.open("doors", options=("--episode", "--seed", "3"))
        self.assertEqual(self.browser.js("document.querySelector('.chip').textContent"), "Opened")
        first = self.browser.screenshot()
        self.browser.js("(() => { const s = document.getElementById('time'); s.value = s.max; s.dispatchEvent(new Event('input')); })()")
        self.browser.settle()
        self.assertNotEqual(self.browser.screenshot(), first)
        self.assertGreater(self.browser.js("doorforge.view.episode.hinge.at(-1)"), np.radians(45))
        self.browser.js("document.getElementById('time').focus(), 0")
        frame = self.browser.js("doorforge.view.at")
        self.browser.key("ArrowLeft")
        self.assertEqual(self.browser.js("doorforge.view.at"), frame - 1)
        for marks in ("Robot", "Cloud", "Action"):
            before = self.browser.screenshot()
            self.click_text(marks)
            self.assertNotEqual(self.browser.screenshot(), before, marks)
        self.browser.size(390, 844, mobile=True)
        self.assertLessEqual(self.browser.js("document.documentElement.scrollWidth"), 390)

    def test_play_runs_to_the_end(self) -> None:
        self.open("doors", options=("--episode", "--points", "0"))
        self.browser.js("(doorforge.view.toggle(), 0)")
        self.browser.wait("!doorforge.view.playing")
        self.assertEqual(self.browser.js("doorforge.view.at"), self.browser.js("doorforge.view.frameCount - 1"))

    def test_a_film_is_that_of_simulate(self) -> None:
        self.open("doors", options=("--episode", "--seed", "3"))
        told = json.loads(run("simulate", "--door", self.folder / "doors", "--seed", "3", "--json").stdout)["episodes"][0]
        facts = dict(self.browser.js("doorforge.view.episode.facts"))
        self.assertEqual(facts["Detail"], told["detail"])
        self.assertEqual(facts["Outcome"], told["outcome"])

    def test_what_cannot_be_shown_is_refused(self) -> None:
        out = self.folder / "none.html"
        run("compose", "--body", "interior_flush_02", "--handle", "interior_lever_tube_01", "--out", self.folder / "others/b")
        self.assertIn("its door is not in the folders", run("view", self.folder / "data", "--doors", self.folder / "others", "--out", out, code=3).stderr)
        run("view", self.folder / "data", "--doors", self.folder / "doors", "--key", "ep999999", "--out", out, code=3)
        run("view", self.folder / "nowhere", "--doors", self.folder / "doors", "--out", out, code=3)
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Episodes in a real Chromium: a stored one against what the reader reads and numpy calculates, the expert's film.

usage: episode_page_test.py BUILD"""
import json
import pathlib
import shutil
import sys
import unittest

import numpy as np

from kinematics import matrix, poses_of_urdf
from pages import PageTest, run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "programs"))
from sealing import seal  # noqa: E402


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

    def filmed(self, data: str) -> list[dict]:
        films = self.folder / f"{data}.jsonl"
        run("dataset", "films", self.folder / data, "--doors", self.folder / "doors", "--stored", "2", "--out", films, "--overwrite")
        return [json.loads(line) for line in films.read_text().splitlines()]

    def view_with_films(self, data: str, films: pathlib.Path, code: int = 0) -> list[dict]:
        page = self.folder / "page.html"
        self.told = run("view", self.folder / data, "--doors", self.folder / "doors", "--films", films, "--out", page, "--overwrite", code=code).stderr
        self.browser.open(page.as_uri())
        return self.browser.js("doorforge.document.episodes")

    def test_forces_of_stored_episodes_are_those_of_their_films(self) -> None:
        """Of each stage, of a robot on a fixed base and of a flying hand: the numbers of a film at the times of the decisions."""
        for data, stage, options in (("data", "open", None), ("handle", "handle", ()), ("grasp", "grasp", ()),
                                     ("fixed", "open", ("--set", "scene.physics.base=fixed")), ("flying", "open", ("--preset", "doorgym"))):
            if options is not None:
                run("datagen", stage, "--doors", self.folder / "doors", "--out", self.folder / data, "--episodes", "2", "--seed", "3", *options)
            films = self.filmed(data)
            self.assertEqual(len(films), 2, data)
            for episode, film in zip(self.view_with_films(data, self.folder / f"{data}.jsonl"), films):
                times = np.array(film["time_s"])
                places = [int(np.argmin(abs(times - time))) for time in episode["times"]]
                np.testing.assert_allclose(times[places], episode["times"], atol=1e-6)
                for key, recorded in (("hinge", "hinge_rad"), ("handle", "handle_rad")):
                    np.testing.assert_allclose(episode[key], np.array(film[recorded])[places], atol=1e-6)
                for key, recorded in (("force", "force_n"), ("net_force", "net_force_n")):
                    np.testing.assert_allclose(episode[key], np.array(film[recorded])[places], atol=0.006)
                if data != "grasp":  # which is decided before anything is touched
                    self.assertGreater(max(episode["force"]), 5, data)
                self.assertIn("to 1e-6", dict(episode["facts"])["Forces"])
            titles = self.browser.js("[...document.querySelectorAll('.panel h2')].map((h) => h.textContent)")
            self.assertEqual(titles[:2], ["Angles", "Forces on the door"], data)

    def test_a_flying_hand_stands_where_it_was_recorded(self) -> None:
        run("datagen", "open", "--doors", self.folder / "doors", "--out", self.folder / "hand", "--episodes", "1", "--seed", "3", "--preset", "doorgym")
        self.open("hand", options=("--doors", self.folder / "doors"))
        index = json.loads(next(self.folder.glob("hand/open/*/shard-000000.index.json")).read_text())
        tar = next(self.folder.glob("hand/open/*/shard-000000.tar")).read_bytes()
        place = next(m for m in index["episodes"][0]["members"] if m["name"] == "proprio.npy")
        raw = tar[place["offset"]:place["offset"] + place["size"]]
        hands = np.frombuffer(raw[10 + int.from_bytes(raw[8:10], "little"):], "<f4").reshape(-1, 32)[:, 25:28]
        np.testing.assert_allclose(self.browser.js("doorforge.view.episode.hands"), hands, atol=1e-5)

    def test_a_film_of_other_joints_gives_no_forces_and_is_told(self) -> None:
        films = self.filmed("data")
        decision = next(i for i, asked in enumerate(films[0]["asked_m"]) if asked is not None)
        for change, words in ((lambda film: film["robot"][decision].__setitem__(4, film["robot"][decision][4] + 3e-6), "its arm 3 is"),
                              (lambda film: film["hinge_rad"].__setitem__(decision, film["hinge_rad"][decision] - 3e-6), "its hinge is"),
                              (lambda film: film["time_s"].__setitem__(decision, film["time_s"][decision] + 1e-3), "it has no instant"),
                              (lambda film: film["scene"].__setitem__("door_sha256", "0" * 64), "of another door or robot"),
                              (lambda film: film["scene"].__setitem__("seed", 4), "there is no film of")):
            changed = json.loads(json.dumps(films))
            change(changed[0])
            path = self.folder / "changed.jsonl"
            path.write_text("".join(json.dumps(film) + "\n" for film in changed))
            first, second = self.view_with_films("data", path, code=1)
            self.assertIn("no forces are shown", self.told)
            self.assertIn(words, self.told)
            self.assertIsNone(first["force"])
            self.assertNotIn("Forces", dict(first["facts"]))
            self.assertIsNotNone(second["force"])
        path.write_text('{"schema": "x"}\n')
        self.assertIn(f"{path}:1", run("view", self.folder / "data", "--doors", self.folder / "doors", "--films", path, "--out", self.folder / "none.html", code=3).stderr)

    def test_episodes_made_again_otherwise_are_no_films(self) -> None:
        """A data set whose record says another end than its seed gives is not filmed as if it were."""
        data = self.folder / "told"
        shutil.copytree(self.folder / "data", data)
        shard = next(data.glob("open/*/shard-000000.tar"))
        index = shard.with_suffix(".index.json")
        text = shard.read_bytes()
        meta = next(m for m in json.loads(index.read_text())["episodes"][0]["members"] if m["name"] == "meta.json")
        old = text[meta["offset"]:meta["offset"] + meta["size"]]
        new = old.replace(json.loads(old)["state_sha256"].encode(), b"0" * 64)
        seal(data, shard, text, text.replace(old, new))
        out = self.folder / "none.jsonl"
        result = run("dataset", "films", data, "--doors", self.folder / "doors", "--stored", "1", "--out", out, code=2)
        self.assertIn("ep000000: made again it ends as opened, recorded is opened with another final state", result.stderr)
        self.assertFalse(out.exists())

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

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Films of failures: those of a report against its rows and of a data set against its failures, the links that lead to them, and
what cannot be shown. Failures are made by giving the expert four actions.

usage: film_page_test.py BUILD"""
import html.parser
import json
import shutil
import unittest

import numpy as np

from box_arm import box_arm
from kinematics import matrix, poses_of_urdf
from pages import BUILD, PageTest, run

FEW = ("--set", "scene.physics.max_opening_actions=4")


class Links(html.parser.HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.films: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list) -> None:
        address = dict(attributes).get("href", "")
        if tag == "a" and "films.html#" in address:
            self.films.append(address)


class Films(PageTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        for name, handle, latch in (("a", "interior_lever_tube_01", "effort"), ("b", "interior_lever_tube_02", "bolt")):
            run("compose", "--body", "interior_flush_01", "--handle", handle, "--set", f"latch={latch}", "--out", cls.folder / "doors" / name)
        cls.report = cls.folder / "report"
        run("eval", "--opener", "expert", "--doors", cls.folder / "doors", "--seeds", "1", *FEW, "--films", "--out", cls.report)
        cls.rows = json.loads((cls.report / "report.json").read_text())["episodes"]
        cls.films = {(film["scene"]["door_id"], film["scene"]["seed"]): film for film in map(json.loads, (cls.report / "films.jsonl").read_text().splitlines())}

    def film(self, row: dict) -> dict:
        return self.films[row["door_id"], row["seed"]]

    def test_every_failure_is_filmed_as_it_was(self) -> None:
        self.assertEqual([row["outcome"] for row in self.rows], ["door_stuck"] * 2)
        for row in self.rows:
            film = self.film(row)
            self.assertEqual(film["state_sha256"], row["state_sha256"])
            self.assertEqual((film["outcome"], film["detail"]), (row["outcome"], row["detail"]))
            self.assertAlmostEqual(film["time_s"][-1], row["simulated_s"], places=5)
            self.assertAlmostEqual(max(film["hinge_rad"]), row["peak_hinge_rad"], delta=0.02)  # between two instants it may be more
            self.assertLessEqual(max(film["force_n"]), row["peak_force_n"] + 1e-6)
            self.assertGreater(max(film["force_n"]), 0.5 * row["peak_force_n"])
            self.assertTrue(all(net <= force + 200 for net, force in zip(film["net_force_n"], film["force_n"])))
            self.assertEqual(film["force_n"][0], 0)  # nothing is touched before the hand has come
            steps = np.diff(film["time_s"])
            self.assertTrue((steps > 0).all() and steps.max() < 0.35, steps)  # a film, and no pair of pictures
            self.assertEqual([film["phase"][0], film["phase"][-1]], ["start", "end"])
            self.assertEqual(sum(asked is not None for asked in film["asked_m"]), row["opening_actions"])

    def test_the_report_links_every_failure_to_its_film(self) -> None:
        links = Links((self.report / "report.html").read_text()).films
        addresses = {f"films.html#{row['door_id']}/{row['seed']}/{row['episode']}" for row in self.rows}
        self.assertEqual(set(links), addresses)
        for row in self.rows:
            self.browser.open((self.report / "films.html").as_uri() + f"#{row['door_id']}/{row['seed']}/{row['episode']}")
            film = self.film(row)
            self.assertEqual(self.browser.js("document.querySelector('dialog[open] .chip').textContent"), "Not opened")
            shown = self.browser.js("doorforge.report.film.episode")
            for key, recorded in (("hinge", "hinge_rad"), ("handle", "handle_rad"), ("times", "time_s")):
                np.testing.assert_allclose(shown[key], film[recorded])
            np.testing.assert_allclose(shown["force"], film["force_n"], atol=0.006)
            np.testing.assert_allclose(shown["net_force"], film["net_force_n"], atol=0.006)
            self.assertEqual(self.browser.js("[...document.querySelectorAll('dialog[open] h2')].map((h) => h.textContent)")[:2], ["Angles", "Forces on the door"])
            self.browser.open("about:blank", ready=False)

    def test_robot_and_door_stand_where_they_stood(self) -> None:
        row = self.rows[0]
        film = self.film(row)
        self.browser.open((self.report / "films.html").as_uri() + f"#{row['door_id']}/{row['seed']}/{row['episode']}")
        world = matrix(film["scene"]["world_from_door"])
        grasped = film["phase"].index("unlock")
        for frame in (0, grasped, len(film["time_s"]) - 1):
            self.browser.js(f"(doorforge.report.film.show({frame}), 0)")
            angles = {"hinge": film["hinge_rad"][frame], "handle_joint": film["handle_rad"][frame]}
            expected = poses_of_urdf(self.folder / "doors/a/model.urdf", angles)
            for pose, link in zip(self.browser.js("doorforge.report.film.poses"), ("base", "leaf", "handle")):
                np.testing.assert_allclose(np.reshape(pose, (4, 4)).T, world @ expected[link], atol=1e-5)
        # the hand is at the handle while it turns it: the grasp of the door's record, within what a grasp may be off
        record = json.loads((self.folder / "doors/a/door.json").read_text())
        grasp = world @ poses_of_urdf(self.folder / "doors/a/model.urdf", {"hinge": film["hinge_rad"][grasped], "handle_joint": film["handle_rad"][grasped]})["handle"]
        hand = np.array(self.browser.js(f"doorforge.report.film.episode.hands[{grasped}]"))
        self.assertLess(np.linalg.norm(hand - grasp[:3, 3]), 0.35, record["id"])

    def test_rows_are_filtered_and_played_by_keyboard(self) -> None:
        self.browser.open((self.report / "films.html").as_uri())
        self.assertIn("2 of 2 episodes, 2 with a film", self.browser.js("document.querySelector('.count').textContent"))
        self.browser.js("(() => { const t = document.getElementById('text'); t.value = 'tube_02'; t.dispatchEvent(new Event('input')); })()")
        self.assertEqual(self.browser.js("document.querySelectorAll('tbody tr').length"), 1)
        self.browser.js("document.querySelector('tbody button').focus()")
        self.browser.key("Enter")
        self.browser.wait("document.querySelector('dialog[open]') !== null")
        self.assertIn("tube_02", self.browser.js("document.querySelector('dialog[open] h1').textContent"))
        self.browser.key("Escape")
        self.browser.wait("document.querySelector('dialog[open]') === null")

    def test_small_screen(self) -> None:
        self.browser.size(390, 844, mobile=True)
        self.browser.open((self.report / "films.html").as_uri())
        self.assertLessEqual(self.browser.js("document.documentElement.scrollWidth"), 390)

    def test_a_report_without_films_shows_its_rows(self) -> None:
        bare = self.folder / "bare"
        bare.mkdir()
        shutil.copy(self.report / "report.json", bare)
        self.open("bare")
        self.assertEqual(self.browser.js("[document.querySelectorAll('tbody tr').length, document.querySelectorAll('tbody button').length]"), [2, 0])

    def test_films_of_other_doors_are_left_out_and_told(self) -> None:
        page = self.folder / "part.html"
        result = run("view", self.report, "--doors", self.folder / "doors/a", "--out", page, code=1)
        self.assertIn("interior_flush_01__interior_lever_tube_02/1/0: its door is not in the folders", result.stderr)
        self.browser.open(page.as_uri())
        self.assertEqual(self.browser.js("document.querySelectorAll('tbody button').length"), 1)

    def test_damaged_films_are_refused_with_their_line(self) -> None:
        lines = (self.report / "films.jsonl").read_text().splitlines()
        film = json.loads(lines[1])
        for number, change in enumerate(({"hinge_rad": film["hinge_rad"][:-1]}, {"outcome": "flew"}, {"robot": [[0.0]] + film["robot"][1:]}, {"schema": "x"}, {"time_s": []},
                                         {"force_n": ["a"] * len(film["force_n"])})):
            path = self.folder / f"damaged_{number}.jsonl"
            path.write_text(lines[0] + "\n" + json.dumps(film | change) + "\n")
            result = run("view", path, "--doors", self.folder / "doors", "--out", self.folder / "none.html", code=3)
            self.assertIn(f"{path}:2", result.stderr)

    def test_damaged_reports_are_refused(self) -> None:
        report = json.loads((self.report / "report.json").read_text())
        for number, change in enumerate(({"schema": 3}, {"schema": "doorforge.door"}, {"episodes": 3}, {"episodes": [3]}, {"episodes": [{}]},
                                         {"episodes": [report["episodes"][0] | {"seed": -1}]})):
            folder = self.folder / f"damaged_{number}"
            folder.mkdir()
            (folder / "report.json").write_text(json.dumps(report | change))
            result = run("view", folder, "--doors", self.folder / "doors", "--out", self.folder / "none.html", code=3)
            self.assertIn(f"{folder}/report.json", result.stderr)

    def test_films_of_a_data_set_are_its_failures(self) -> None:
        data = self.folder / "data"
        run("datagen", "open", "--doors", self.folder / "doors", "--out", data, "--episodes", "4", *FEW, code=1)
        films = self.folder / "data_films.jsonl"
        run("dataset", "films", data, "--doors", self.folder / "doors", "--out", films)
        made = {film["scene"]["episode"]: film for film in map(json.loads, films.read_text().splitlines())}
        failures = [json.loads(line) for line in (data / "failures.jsonl").read_text().splitlines()]
        self.assertEqual(len(failures), 4)
        for failure in failures:
            film = made[int(failure["key"].removeprefix("ep"))]
            self.assertEqual((film["scene"]["door_id"], film["outcome"], film["detail"]), (failure["door_id"], failure["outcome"], failure["detail"]))
            self.assertAlmostEqual(max(film["hinge_rad"]), failure["peak_hinge_rad"], delta=0.02)
        page = self.folder / "films.html"
        run("view", films, "--doors", self.folder / "doors", "--out", page)
        run("dataset", "info", data, "--html", self.folder / "data.html", "--films", page)
        links = Links((self.folder / "data.html").read_text()).films
        self.assertEqual(len(links), 4)
        for link in links:
            self.browser.open(page.as_uri() + "#" + link.partition("#")[2])
            self.assertEqual(self.browser.js("document.querySelector('dialog[open] .chip').textContent"), "Not opened")
            self.browser.open("about:blank", ready=False)

    def test_other_doors_make_no_films(self) -> None:
        data = self.folder / "other"
        run("datagen", "open", "--doors", self.folder / "doors/a", "--out", data, "--episodes", "1", *FEW, code=1)
        run("dataset", "films", data, "--doors", self.folder / "doors/b", "--out", self.folder / "none.jsonl", code=2)
        self.assertFalse((self.folder / "none.jsonl").exists())

    def test_robots_of_users_are_drawn(self) -> None:
        robot = self.folder / "box_arm.urdf"
        robot.write_text(box_arm())
        data, films = self.folder / "arm", self.folder / "arm.jsonl"
        run("datagen", "open", "--doors", self.folder / "doors/a", "--robot", robot, "--out", data, "--episodes", "1", "--set", "scene.physics.max_opening_actions=1", code=1)
        run("dataset", "films", data, "--doors", self.folder / "doors/a", "--robot", robot, "--out", films)
        film = json.loads(films.read_text())
        self.assertEqual(film["scene"]["robot"]["name"], "box_arm")
        page = self.folder / "arm.html"
        result = run("view", films, "--doors", self.folder / "doors", "--out", page, code=1)
        self.assertIn("--robot", result.stderr)
        run("view", films, "--doors", self.folder / "doors", "--robot", robot, "--out", page, "--overwrite")
        self.browser.open(page.as_uri())
        shown = self.browser.js("doorforge.document.robot")
        self.assertEqual(shown["bodies"], len(film["robot"][0]) + 1)  # a body a joint, and the base
        self.assertEqual({piece["body"] for piece in shown["pieces"]}, set(range(1, 11)))  # pedestal on the sliders, seven links, fingers
        self.browser.click_on("tbody button")
        self.browser.wait("document.querySelector('dialog[open]') !== null")
        run("view", self.folder / "doors/a", "--episode", "--robot", robot, "--out", page, "--overwrite")
        self.browser.open(page.as_uri())
        self.assertEqual(self.browser.js("doorforge.document.robot.bodies"), shown["bodies"])


if __name__ == "__main__":
    unittest.main()

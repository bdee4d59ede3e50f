# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What is refused is said with its files, in our words: pictures that do not fit, settings of a door, XML."""
import json
import unittest

from programs import ProgramTest, run
from sound_inputs import grey_png, write_sight


class ActMessages(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        write_sight(self.folder)
        self.depth, self.camera = self.folder / "tested_depth.png", self.folder / "tested_camera.yaml"
        self.state, self.mask = self.folder / "tested_state.yaml", self.folder / "tested_mask.png"

    def act(self, *more: object):
        # the picture is a slanted plane, on which a policy rightly says hold
        return run("act", "--least-gain", "off", "--foreign-limit", "off", "--depth", self.depth, "--camera",
                   self.camera, *more)

    def open(self):
        return self.act("--state", self.state, "--opener", self.folder / "tested_opener")

    def grasp(self):
        return self.act("--handle-mask", self.mask, "--grasper", self.folder / "tested_grasper")

    def assert_names(self, result, *paths) -> None:
        self.assert_refused(result, 2)
        for path in paths:
            self.assertIn(str(path), result.stderr)

    def test_sound_files_are_taken(self):
        self.assert_ends(self.open(), 0)
        self.assert_ends(self.grasp(), 0)

    def test_a_picture_of_another_size_than_the_camera_file_says(self):
        self.camera.write_text(self.camera.read_text().replace("160", "150"))
        self.assert_names(self.open(), self.depth, self.camera)
        self.assert_names(self.grasp(), self.depth, self.camera)

    def test_a_picture_without_depth(self):
        self.depth.write_bytes(grey_png(160, 120, lambda x, y: 0))
        self.assert_names(self.open(), self.depth, self.camera)

    def test_a_mask_of_another_size_and_an_empty_one(self):
        self.mask.write_bytes(grey_png(80, 60, lambda x, y: 1))
        self.assert_names(self.grasp(), self.depth, self.mask)
        self.mask.write_bytes(grey_png(160, 120, lambda x, y: 0))
        self.assert_names(self.grasp(), self.depth, self.mask)


class OtherMessages(ProgramTest):
    def test_a_door_that_a_config_asks_for_and_cannot_be_made(self):
        config = self.folder / "mine.yaml"
        config.write_text("body: interior_flush_01\nhandle: interior_lever_tube_01\nleaf_width_m: 1e39\n")
        result = run("compose", "--config", config, "--out", self.folder / "door")
        self.assert_refused(result, 2)
        self.assertIn(str(config), result.stderr)

    def test_a_config_that_names_no_parts(self):
        config = self.folder / "mine.yaml"
        for text, code in (("{}\n", 2), ("body: " + "x" * 500 + "\nhandle: safe_ell_01\n", 3),
                           ("body: safe_antique_01\nhandle: mine.stl\n", 3)):
            config.write_text(text)
            result = run("compose", "--config", config, "--out", self.folder / "door")
            self.assert_refused(result, code)
            self.assertIn(str(config), result.stderr)

    def test_physics_that_no_settings_allow(self):
        config, door = self.folder / "mine.yaml", self.folder / "door"
        run("compose", "--body", "safe_antique_01", "--handle", "safe_ell_01", "--out", door)
        config.write_text("scene: {physics: {time_step_s: 1}}\n")
        result = run("simulate", "--door", door, "--seeds", 1, "--config", config)
        self.assert_refused(result, 2)
        self.assertIn(str(config), result.stderr)

    def test_a_joint_whose_limits_are_swapped(self):
        door = self.folder / "door"
        run("compose", "--body", "safe_antique_01", "--handle", "safe_ell_01", "--out", door)
        record = json.loads((door / "door.json").read_text())
        record["hinge"]["lower_rad"], record["hinge"]["upper_rad"] = 1.0, 0.5
        (door / "door.json").write_text(json.dumps(record))
        for command in (["preview", door, "--out", self.folder / "a.png"],
                        ["preview", door, "--out", self.folder / "b.png", "--episode"]):
            result = run(*command)
            self.assert_ends(result, 2, 3)  # 2: a door that no world can be made of
            self.assertIn("door", result.stderr.replace("doorforge", ""))
        self.assert_ends(run("validate", door, "--profile", "openable"), 1)

    def test_a_robot_that_is_no_xml(self):
        robot, door = self.folder / "mine.urdf", self.folder / "door"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", door), 0)
        for text in ("", "garbage", '<robot name="a"><link name="b"></robot>'):
            robot.write_text(text)
            result = run("simulate", "--door", door, "--seeds", 1, "--robot", robot)
            self.assert_refused(result, 2, 3)
            self.assertIn(str(robot), result.stderr)
            self.assertNotIn("XML_", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

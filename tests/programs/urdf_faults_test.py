# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Every fault of a URDF in one run, each with its line."""
import json
import unittest

from programs import ProgramTest, run

SOUND = """<?xml version="1.0"?>
<robot name="gate">
  <link name="post">
    <visual><geometry><box size="0.1 0.1 1.2"/></geometry></visual>
  </link>
  <link name="leaf">
    <inertial>
      <mass value="12"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="0.5"/>
    </inertial>
    <visual>
      <origin xyz="0 0.5 0"/>
      <geometry><box size="0.04 0.9 1.1"/></geometry>
    </visual>
  </link>
  <joint name="hinge" type="revolute">
    <parent link="post"/>
    <child link="leaf"/>
    <origin xyz="0 0.05 0"/>
    <axis xyz="0 0 -1"/>
    <limit lower="0" upper="1.5" effort="30" velocity="2"/>
  </joint>
</robot>
"""

# What is written in place of what, and what the message says of it.
FAULTS = {
    '<mass value="12"/>': ('<mass value="-5"/>', '<mass> of link "leaf": value is -5, allowed 0 and more'),
    '<geometry><box size="0.04 0.9 1.1"/></geometry>':
        ('<geometry><mesh filename="no/leaf.obj"/></geometry>', '<mesh> of link "leaf": filename="no/leaf.obj" is missing'),
    '<axis xyz="0 0 -1"/>': ('<axis xyz="0 0 0"/>', '<axis> of joint "hinge": xyz="0 0 0" is an axis of zero length'),
    '<limit lower="0" upper="1.5" effort="30" velocity="2"/>':
        ('<limit lower="1.5" upper="0" velocity="2"/>', '<limit> of joint "hinge": lower is 1.5, allowed at most upper'),
    '<box size="0.1 0.1 1.2"/>': ('<box size="0.1 -0.1 1.2"/>', "<box> of link \"post\": the least of size is -0.1"),
}


def line_of(text: str, part: str) -> int:
    return next(number for number, line in enumerate(text.splitlines(), 1) if part in line)


class UrdfFaults(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.urdf = self.folder / "bad.urdf"

    def import_it(self, text: str, *more: str):
        self.urdf.write_text(text)
        return run("import", self.urdf, "--category", "interior", "--out", self.folder / "parts", *more)

    def test_one_run_names_all_of_them_with_their_lines(self):
        text = SOUND
        for sound, (broken, _) in FAULTS.items():
            text = text.replace(sound, broken)
        result = self.import_it(text)
        self.assert_refused(result, 3)
        self.assertIn("bad.urdf: 6 faults", result.stderr)
        at = 0
        for broken, message in sorted(FAULTS.values(), key=lambda fault: line_of(text, fault[0])):
            expected = f"{self.urdf}:{line_of(text, broken)}: {message}"
            self.assertIn(expected, result.stderr)
            # in the order of the file
            self.assertGreater(result.stderr.index(expected), at)
            at = result.stderr.index(expected)
        self.assertIn(f"{self.urdf}:{line_of(text, '<limit')}: <limit> of joint \"hinge\": no effort", result.stderr)

    def test_each_alone_is_named_with_its_line(self):
        for sound, (broken, message) in FAULTS.items():
            text = SOUND.replace(sound, broken)
            result = self.import_it(text.replace('upper="0" velocity', 'upper="0" effort="1" velocity'))
            self.assert_refused(result, 3)
            self.assertIn(f"{self.urdf}:{line_of(text, broken)}: {message}", result.stderr)

    def test_what_an_import_does_without_is_a_note(self):
        result = self.import_it(SOUND.replace(' effort="30"', ""))
        self.assert_ends(result, 0)
        self.assertIn('<limit> of joint "hinge": no effort, which the format asks for', result.stdout)
        self.assertNotIn("no effort", self.import_it(SOUND, "--overwrite").stdout)

    def test_validate_makes_a_finding_of_each(self):
        door = self.folder / "door"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out",
                             door), 0)
        urdf = door / "model.urdf"
        text = urdf.read_text().replace("<axis xyz", '<axis xyz="0 0 0" was')
        urdf.write_text(text)
        result = run("validate", door, "--json")
        self.assert_ends(result, 1)
        findings = [finding for finding in json.loads(result.stdout)["findings"] if finding["code"] == "URD001"]
        lines = [number for number, line in enumerate(text.splitlines(), 1) if "<axis" in line]
        self.assertEqual([finding["where"] for finding in findings], [f"model.urdf:{line}" for line in lines])
        self.assertEqual(len(lines), 2)


if __name__ == "__main__":
    unittest.main()

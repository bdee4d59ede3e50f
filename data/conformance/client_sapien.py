# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""SAPIEN (PhysX): URDF, without a renderer and so without visuals."""
import importlib.metadata
import logging
import os
import re
import tempfile

import numpy
import sapien

from judge import STEP_S

VERSION = "SAPIEN " + importlib.metadata.version("sapien")
FORMATS = {"urdf": "a fixed tendon for <mimic>, the handle's spring as a drive, no joint friction; visuals left out"}
logging.disable(logging.WARNING)


def without_visuals(path):
    """The file's text beside it would be a second one in the user's folder, so it goes to a temporary one."""
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"<visual\b.*?</visual>", "", file.read(), flags=re.S)
    folder = os.path.dirname(os.path.abspath(path))
    return re.sub(r'filename="(?!/)', f'filename="{folder}/', text)


class World:
    def __init__(self, path, spring):
        self.scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
        self.scene.set_timestep(STEP_S)
        loader = self.scene.create_urdf_loader()
        loader.fix_root_link = True
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, "model.urdf")
            with open(copy, "w", encoding="utf-8") as file:
                file.write(without_visuals(path))
            builder = loader.load_file_as_articulation_builder(copy)
            self.door = builder.build(fix_root_link=True, build_mimic_joints=False)
        self.add_tendons(builder.mimic_joint_records)
        self.order = {joint.name: i for i, joint in enumerate(self.door.active_joints)}
        self.spring, self.friction = spring, 0.0
        for joint in self.door.active_joints:
            joint.set_friction(0.0)  # SAPIEN takes the file's torque for a coefficient
            if joint.name == "handle_joint":
                joint.set_drive_properties(spring, 0.0)

    def add_tendons(self, mimics):
        """SAPIEN's own make the leader follow: on joints of one parent they have the ratio upside down."""
        for mimic in mimics:
            follower, leader = (self.door.find_joint_by_name(name) for name in (mimic.joint, mimic.mimic))
            self.door.create_fixed_tendon([follower.parent_link, follower.child_link, leader.child_link],
                                          [0, 1, -mimic.multiplier], [0, 1, -mimic.multiplier],
                                          rest_length=mimic.offset, stiffness=1e5)

    def links(self):
        return {link.name: float(link.mass) for link in self.door.links}

    def limits(self):
        return {joint.name: tuple(map(float, joint.limits[0])) for joint in self.door.active_joints}

    def angle(self, joint):
        return float(self.door.qpos[self.order[joint]])

    def speed(self, joint):
        return float(self.door.qvel[self.order[joint]])

    def step(self, torques):
        forces = numpy.zeros(len(self.order), dtype=numpy.float32)
        for joint, torque in torques.items():
            forces[self.order[joint]] = torque
        self.door.set_qf(forces)
        self.scene.step()


def load(path, form, job):
    return World(path, job["handle_spring_nm_per_rad"])

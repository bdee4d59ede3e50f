# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""PyBullet: URDF. It leaves self-collision off, ignores <mimic> and puts motors on every joint, so the loader asks for
the first, adds a gear for the second and takes the third away but for the friction that the file names."""
import importlib.metadata
import xml.etree.ElementTree

import pybullet

from judge import STEP_S

FORMATS = {"urdf": "URDF_USE_SELF_COLLISION, a gear constraint for <mimic>, no default motors"}
VERSION = "PyBullet " + importlib.metadata.version("pybullet")
pybullet.connect(pybullet.DIRECT)


class World:
    def __init__(self, path):
        pybullet.resetSimulation()
        pybullet.setGravity(0, 0, -9.81)
        pybullet.setTimeStep(STEP_S)
        self.body = pybullet.loadURDF(path, useFixedBase=True, flags=pybullet.URDF_USE_SELF_COLLISION
                                      | pybullet.URDF_USE_INERTIA_FROM_FILE)
        infos = [pybullet.getJointInfo(self.body, i) for i in range(pybullet.getNumJoints(self.body))]
        self.joints = {info[1].decode(): info for info in infos if info[2] != pybullet.JOINT_FIXED}
        self.names = [info[12].decode() for info in infos]
        for info in self.joints.values():
            pybullet.setJointMotorControl2(self.body, info[0], pybullet.VELOCITY_CONTROL, force=info[7])
        self.spring, self.friction = 0.0, self.joints["handle_joint"][7] if "handle_joint" in self.joints else 0.0
        self.add_gears(path)

    def add_gears(self, path):
        for joint in xml.etree.ElementTree.parse(path).getroot().iter("joint"):
            mimic = joint.find("mimic")
            if mimic is None or joint.get("name") not in self.joints:
                continue
            leader, follower = self.joints[mimic.get("joint")][0], self.joints[joint.get("name")][0]
            gear = pybullet.createConstraint(self.body, leader, self.body, follower, pybullet.JOINT_GEAR, [0, 1, 0],
                                             [0, 0, 0], [0, 0, 0])
            # the ratio is that of the follower's row: leader + ratio * follower = 0
            pybullet.changeConstraint(gear, gearRatio=-1 / float(mimic.get("multiplier", 1)), maxForce=1000, erp=0.8)

    def links(self):
        masses = {name: pybullet.getDynamicsInfo(self.body, i)[0] for i, name in enumerate(self.names)}
        return masses

    def limits(self):
        return {name: (info[8], info[9]) for name, info in self.joints.items()}

    def angle(self, joint):
        return pybullet.getJointState(self.body, self.joints[joint][0])[0]

    def speed(self, joint):
        return pybullet.getJointState(self.body, self.joints[joint][0])[1]

    def step(self, torques):
        for joint, torque in torques.items():
            pybullet.setJointMotorControl2(self.body, self.joints[joint][0], pybullet.TORQUE_CONTROL, force=torque)
        pybullet.stepSimulation()


def load(path, form, job):
    return World(path)

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""MuJoCo: MJCF, and URDF as MuJoCo compiles it."""
import mujoco

from judge import STEP_S

VERSION = "MuJoCo " + mujoco.__version__
FORMATS = {"mjcf": "", "urdf": ""}


class World:
    def __init__(self, path):
        self.model = mujoco.MjModel.from_xml_path(path)
        self.model.opt.timestep = STEP_S
        self.data = mujoco.MjData(self.model)
        names = [self.model.joint(i).name for i in range(self.model.njnt)]
        handle = self.model.joint("handle_joint") if "handle_joint" in names else None
        self.spring = float(handle.stiffness[0]) if handle else 0.0
        self.friction = float(self.model.dof_frictionloss[handle.dofadr[0]]) if handle else 0.0

    def links(self):
        names = [self.model.body(i).name for i in range(1, self.model.nbody)]
        return {name: float(self.model.body(name).mass[0]) for name in names}

    def limits(self):
        return {self.model.joint(i).name: tuple(map(float, self.model.joint(i).range)) for i in range(self.model.njnt)}

    def angle(self, joint):
        return float(self.data.joint(joint).qpos[0])

    def speed(self, joint):
        return float(self.data.joint(joint).qvel[0])

    def step(self, torques):
        for joint, torque in torques.items():
            self.data.qfrc_applied[self.model.joint(joint).dofadr[0]] = torque
        mujoco.mj_step(self.model, self.data)


def load(path, form, job):
    return World(path)

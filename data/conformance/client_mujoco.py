# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""MuJoCo: MJCF, and URDF. A frame that is fixed to the world touches its own leaf in MuJoCo, and what <mimic> becomes is as soft
as the bolt is light, so the loader of a URDF sets both right."""
import mujoco

from judge import STEP_S

VERSION = "MuJoCo " + mujoco.__version__
FORMATS = {"mjcf": "", "urdf": "MjSpec.add_exclude for frame, leaf and handle; a hard equality for <mimic>"}
STIFF, HARD = [0.005, 1], [0.99, 0.999, 0.0001, 0.5, 2]  # as the MJCF has them


def spec_of(path, form):
    spec = mujoco.MjSpec.from_file(path)
    if form == "urdf":
        spec.compiler.fusestatic = False  # the frame stays a body, which an exclusion can name
        for one, other in (("base", "leaf"), ("base", "handle")):
            spec.add_exclude(bodyname1=one, bodyname2=other)
        for equality in spec.equalities:
            equality.solref, equality.solimp = STIFF, HARD
    return spec


class World:
    def __init__(self, path, form):
        self.model = spec_of(path, form).compile()
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
    return World(path, form)

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Newton with its MuJoCo solver, on the processor: USD, URDF and MJCF."""
import importlib.metadata

import newton
import numpy
import warp

from judge import STEP_S

VERSION = "Newton " + importlib.metadata.version("newton")
FORMATS = {"usda": "rigid_gap = 0, enable_multiccd, a hard equality for the mimic joint", "mjcf": "",
           "urdf": "rigid_gap = 0, enable_multiccd, harder shapes (default_shape_cfg.ke), a hard equality for <mimic>"}
warp.config.quiet = True
warp.set_device("cpu")


class World:
    def __init__(self, path, form, spring):
        builder = newton.ModelBuilder()
        newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
        if form != "mjcf":
            builder.rigid_gap = 0.0  # the usual 0.1 m leaves one point a contact, whose normal is that of swollen shapes
        if form == "usda":
            builder.add_usd(path)
        elif form == "urdf":
            builder.default_shape_cfg.ke, builder.default_shape_cfg.kd = 4e4, 4e2  # the usual 2.5e3 gives way by centimetres
            builder.add_urdf(path, floating=False)
        else:
            builder.add_mjcf(path)
        self.model = builder.finalize()
        more = {} if form == "mjcf" else {"enable_multiccd": True}
        self.solver = newton.solvers.SolverMuJoCo(self.model, use_mujoco_cpu=True, **more)
        if form != "mjcf":  # what a mimic becomes is as soft as the bolt is light
            self.solver.mj_model.eq_solref[:], self.solver.mj_model.eq_solimp[:] = [0.005, 1], [0.99, 0.999, 0.0001, 0.5, 2]
        self.now, self.next = self.model.state(), self.model.state()
        self.control = self.model.control()
        self.names = [label.split("/")[-1] for label in self.model.joint_label]
        self.start = self.model.joint_q_start.numpy()
        self.dof = self.model.joint_qd_start.numpy()
        self.force = numpy.zeros(self.model.joint_dof_count, dtype=numpy.float32)
        self.spring = 0.0 if form == "urdf" else spring
        self.friction = 0.0
        if form == "urdf" and "handle_joint" in self.names:
            self.friction = float(self.model.joint_friction.numpy()[self.dof[self.index("handle_joint")]])

    def index(self, joint):
        return self.names.index(joint)

    def links(self):
        names = [label.split("/")[-1] for label in self.model.body_label]
        return dict(zip(names, map(float, self.model.body_mass.numpy())))

    def limits(self):
        lower, upper = self.model.joint_limit_lower.numpy(), self.model.joint_limit_upper.numpy()
        return {name: (float(lower[self.dof[i]]), float(upper[self.dof[i]])) for i, name in enumerate(self.names)
                if self.dof[i + 1] == self.dof[i] + 1}

    def angle(self, joint):
        return float(self.now.joint_q.numpy()[self.start[self.index(joint)]])

    def speed(self, joint):
        return float(self.now.joint_qd.numpy()[self.dof[self.index(joint)]])

    def step(self, torques):
        for joint, torque in torques.items():
            self.force[self.dof[self.index(joint)]] = torque
        self.control.joint_f.assign(self.force)
        self.now.clear_forces()
        self.solver.step(self.now, self.next, self.control, None, STEP_S)
        self.now, self.next = self.next, self.now


def load(path, form, job):
    return World(path, form, job["handle_spring_nm_per_rad"])

# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Drake: URDF, SDF and MJCF, in discrete steps with the SAP solver, the one that enforces <mimic>. Of MJCF it reads neither tendons
nor springs of joints, so the loader couples the bolt by what the file's tendon says."""
import importlib.metadata
import logging
import xml.etree.ElementTree

import numpy
from pydrake.all import AddMultibodyPlantSceneGraph, DiagramBuilder, DiscreteContactApproximation, Parser, Simulator

from judge import STEP_S

VERSION = "Drake " + importlib.metadata.version("drake")
FORMATS = {"urdf": "welded to the world, the handle's spring as a torque", "sdf": "",
           "mjcf": "AddCouplerConstraint for the tendon, the handle's spring as a torque"}
logging.getLogger("drake").setLevel(logging.ERROR)


def cables(path):
    """The joints of each fixed tendon, with their coefficients."""
    for tendon in xml.etree.ElementTree.parse(path).getroot().iter("fixed"):
        yield {joint.get("joint"): float(joint.get("coef")) for joint in tendon.iter("joint")}


class World:
    def __init__(self, path, form, spring):
        self.spring, self.friction, self.applied = spring, 0.0, form != "sdf"
        builder = DiagramBuilder()
        self.plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=STEP_S)
        self.plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
        model, = Parser(self.plant).AddModels(path)
        if form == "urdf":
            self.plant.WeldFrames(self.plant.world_frame(), self.plant.GetFrameByName("base", model))
        self.model = model
        if form == "mjcf":
            for cable in cables(path):
                bolt, handle = cable
                self.plant.AddCouplerConstraint(self.joint(bolt), self.joint(handle), -cable[handle] / cable[bolt])
        self.plant.Finalize()
        self.diagram = builder.Build()
        self.simulator = Simulator(self.diagram)
        self.context = self.plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        self.simulator.Initialize()
        self.forces = self.plant.get_applied_generalized_force_input_port()

    def joint(self, name):
        return self.plant.GetJointByName(name, self.model)

    def links(self):
        bodies = [self.plant.get_body(index) for index in self.plant.GetBodyIndices(self.model)]
        return {body.name(): body.default_mass() for body in bodies}

    def limits(self):
        joints = [self.plant.get_joint(index) for index in self.plant.GetJointIndices(self.model)]
        return {joint.name(): (float(joint.position_lower_limits()[0]), float(joint.position_upper_limits()[0]))
                for joint in joints if joint.num_positions() == 1}

    def angle(self, joint):
        return float(self.plant.GetPositions(self.context)[self.joint(joint).position_start()])

    def speed(self, joint):
        return float(self.plant.GetVelocities(self.context)[self.joint(joint).velocity_start()])

    def step(self, torques):
        forces = numpy.zeros(self.plant.num_velocities())
        for joint, torque in torques.items():
            forces[self.joint(joint).velocity_start()] = torque
        if self.applied and "handle_joint" in torques:
            forces[self.joint("handle_joint").velocity_start()] -= self.spring * self.angle("handle_joint")
        self.forces.FixValue(self.context, forces)
        self.simulator.AdvanceTo(self.simulator.get_context().get_time() + STEP_S)


def load(path, form, job):
    return World(path, form, job["handle_spring_nm_per_rad"])

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/message.h"
#include "doorforge/schemas/urdf.h"

// What doorforge-read-model sends of an object that is imported.

namespace doorforge {

template <class Message>
void Exchange(Message& message, TriangleMesh& mesh) {
  message(mesh.vertices, mesh.triangles);
}
template <class Message>
void Exchange(Message& message, UrdfMeshFile& file) {
  message(file.filename, file.scale, file.line);
}
template <class Message>
void Exchange(Message& message, UrdfBox& box) {
  message(box.size_m);
}
template <class Message>
void Exchange(Message& message, UrdfCylinder& cylinder) {
  message(cylinder.radius_m, cylinder.length_m);
}
template <class Message>
void Exchange(Message& message, UrdfSphere& sphere) {
  message(sphere.radius_m);
}
template <class Message>
void Exchange(Message& message, UrdfTriangles& triangles) {
  message(triangles.mesh);
}
template <class Message>
void Exchange(Message& message, UrdfShape& shape) {
  message(shape.name, shape.link_from_shape, shape.geometry, shape.color_rgba);
}
template <class Message>
void Exchange(Message& message, MassProperties& mass) {
  message(mass.mass_kg, mass.center_of_mass_m, mass.inertia_kg_m2);
}
template <class Message>
void Exchange(Message& message, UrdfLink& link) {
  message(link.name, link.inertial, link.visuals, link.collisions);
}
template <class Message>
void Exchange(Message& message, UrdfMimic& mimic) {
  message(mimic.joint, mimic.multiplier, mimic.offset);
}
template <class Message>
void Exchange(Message& message, UrdfJoint& joint) {
  message.Choice(joint.type, UrdfJointType::kPrismatic);
  message(joint.name, joint.parent, joint.child, joint.parent_from_joint, joint.axis, joint.lower,
          joint.upper, joint.effort, joint.velocity, joint.damping, joint.friction, joint.mimic);
}
template <class Message>
void Exchange(Message& message, UrdfModel& model) {
  message(model.name, model.links, model.joints, model.mujoco_reads_visuals, model.words);
}
template <class Message>
void Exchange(Message& message, UrdfFault& fault) {
  message.Choice(fault.kind, UrdfFaultKind::kUnstated);
  message(fault.line, fault.text);
}

/// What came of a file: a model with its faults, or an error.
struct ReadModelAnswer {
  bool failed = false;
  ErrorCode code = ErrorCode::kFormat;
  std::string problem;
  UrdfModel model;
  std::vector<UrdfFault> faults;
};
template <class Message>
void Exchange(Message& message, ReadModelAnswer& answer) {
  message.Choice(answer.code, ErrorCode::kIncomplete);
  message(answer.failed, answer.problem, answer.model, answer.faults);
}

}  // namespace doorforge

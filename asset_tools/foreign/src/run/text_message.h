// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/core/message.h"
#include "doorforge/parts/model_message.h"

#include "run/read_text.h"

// What doorforge-read-model sends of an object that is validated.

namespace doorforge {

template <class Message>
void Exchange(Message& message, SourcePlace& place) {
  message(place.file, place.line, place.column, place.element);
}
template <class Message>
void Exchange(Message& message, ForeignMeshFile& file) {
  message(file.name, file.scale);
}
template <class Message>
void Exchange(Message& message, ForeignBox& box) {
  message(box.size_m);
}
template <class Message>
void Exchange(Message& message, ForeignCylinder& cylinder) {
  message(cylinder.radius_m, cylinder.length_m);
}
template <class Message>
void Exchange(Message& message, ForeignSphere& sphere) {
  message(sphere.radius_m);
}
template <class Message>
void Exchange(Message& message, ForeignShape& shape) {
  message.Choice(shape.use, ShapeUse::kBoth);
  message(shape.name, shape.as_hull, shape.link_from_shape, shape.geometry, shape.place);
}
template <class Message>
void Exchange(Message& message, ForeignInertial& inertial) {
  message(inertial.mass_kg, inertial.center_m, inertial.inertia_kg_m2, inertial.place,
          inertial.mass_place, inertial.inertia_place);
}
template <class Message>
void Exchange(Message& message, ForeignLink& link) {
  message(link.name, link.inertial, link.shapes, link.place);
}
template <class Message>
void Exchange(Message& message, ForeignMimic& mimic) {
  message(mimic.joint, mimic.multiplier, mimic.place);
}
template <class Message>
void Exchange(Message& message, ForeignLimit& limit) {
  message(limit.lower, limit.upper, limit.effort, limit.velocity, limit.place);
}
template <class Message>
void Exchange(Message& message, ForeignJoint& joint) {
  message.Choice(joint.type, ForeignJointType::kOther);
  message(joint.name, joint.parent, joint.child, joint.parent_from_joint, joint.child_from_joint,
          joint.axis, joint.limit, joint.damping, joint.friction, joint.mimic);
  message(joint.place, joint.axis_place, joint.dynamics_place);
}
template <class Message>
void Exchange(Message& message, ForeignFileName& name) {
  message(name.name, name.place, name.optional);
}
template <class Message>
void Exchange(Message& message, FormatTraits& traits) {
  message(traits.one_root, traits.needs_limits, traits.unit_axes, traits.needs_masses);
}
template <class Message>
void Exchange(Message& message, StageFacts& stage) {
  message(stage.unit_m, stage.default_prim, stage.articulations, stage.labelled, stage.with_extent);
}
template <class Message>
void Exchange(Message& message, ArticulatedObject& object) {
  message(object.name, object.links, object.joints, object.files, object.traits, object.place,
          object.y_up, object.stage, object.paired);
}
/// What the rule says of a finding is not sent: FaultList::Restore() knows it.
template <class Message>
void Exchange(Message& message, Finding& finding) {
  message(finding.code, finding.where, finding.measured, finding.place.file, finding.place.line,
          finding.place.column, finding.place.element, finding.place.value, finding.place.unit);
}

namespace foreign {

template <class Message>
void Exchange(Message& message, TextRead& read) {
  message.Choice(read.kind, ValidatedKind::kUnknown);
  message.Choice(read.after, AfterText::kJudge);
  message(read.notes, read.object, read.mesh);
}

/// What the program sends first; what urdfdom says may follow.
struct TextAnswer {
  std::string problem;  ///< Why it was not read: it took too much; empty if it was.
  TextRead read;
  FaultList faults;
};
template <class Message>
void Exchange(Message& message, TextAnswer& answer) {
  message(answer.problem, answer.read, answer.faults);
}

}  // namespace foreign
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "doorforge/core/committed_file.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/schemas/door_words.h"

#include "door_formats.h"
#include "export_text.h"
#include "latch_bodies.h"

namespace doorforge {
namespace {

using internal::AddElement;
using internal::Decimal;
using internal::Decimals;
using internal::LatchBodies;
using internal::SetAttribute;
using internal::XmlElement;

UrdfShape MeshShape(const std::string& file) {
  UrdfShape shape;
  shape.geometry = UrdfMeshFile{.filename = file};
  return shape;
}

void AddBoltLink(const LatchBodies& latch, const DoorAsset& door, UrdfModel& model) {
  UrdfLink link;
  link.name = internal::kBoltLink;
  link.inertial = internal::BoltMass(latch.bolt);
  link.visuals = {MeshShape(internal::kBoltMeshPath)};
  link.collisions = link.visuals;
  link.visuals[0].color_rgba = Eigen::Vector4d(0.75, 0.75, 0.78, 1);
  model.links.push_back(link);

  UrdfJoint joint;
  joint.name = internal::kBoltJoint;
  joint.type = UrdfJointType::kPrismatic;
  joint.parent = door.links[kLeafLink].name;
  joint.child = link.name;
  joint.parent_from_joint = latch.bolt.leaf_from_bolt;
  joint.axis = Eigen::Vector3d::UnitY();
  joint.lower = -latch.bolt.travel_m;
  joint.upper = 0;
  joint.effort = internal::kBoltForce;
  joint.velocity = internal::kBoltSpeed;
  joint.damping = latch.bolt.damping_n_s_m;
  joint.mimic =
      UrdfMimic{.joint = door.handle_joint.name, .multiplier = -latch.bolt.travel_m_per_rad};
  model.joints.push_back(joint);
}

void AddLatch(const LatchBodies& latch, const DoorAsset& door, UrdfModel& model) {
  model.links[kBaseLink].collisions.clear();
  for (const internal::FramePiece& piece : latch.frame)
    model.links[kBaseLink].collisions.push_back(MeshShape(piece.file));
  model.joints[1].friction = latch.handle_friction_nm;
  AddBoltLink(latch, door, model);
}

void AddInterface(const char* kind, const char* name, XmlElement& joint) {
  SetAttribute(AddElement(joint, kind), "name", name);
}

void AddControlled(const UrdfJoint& joint, XmlElement& control) {
  XmlElement& element = AddElement(control, "joint");
  SetAttribute(element, "name", joint.name);
  if (joint.mimic) {
    SetAttribute(element, "mimic", "true");
  } else {
    XmlElement& command = AddElement(element, "command_interface");
    SetAttribute(command, "name", "effort");
    for (const auto& [limit, value] :
         {std::pair{"min", -joint.effort.value_or(0)}, {"max", joint.effort.value_or(0)}}) {
      XmlElement& param = internal::AddText(command, "param", Decimal(value));
      SetAttribute(param, "name", limit);
    }
  }
  for (const char* state : {"position", "velocity"})
    AddInterface("state_interface", state, element);
}

// Limits as ros2_control reads them; its mock hardware stands for the plugin of whoever has one.
XmlElement ControlOf(const UrdfModel& model) {
  XmlElement control{.name = "ros2_control"};
  SetAttribute(control, "name", "door");
  SetAttribute(control, "type", "system");
  internal::AddText(AddElement(control, "hardware"), "plugin", "mock_components/GenericSystem");
  for (const UrdfJoint& joint : model.joints) {
    if (joint.type != UrdfJointType::kFixed) AddControlled(joint, control);
  }
  return control;
}

// What URDF has no word for.
XmlElement WordsOf(const DoorAsset& door) {
  XmlElement words{.name = "doorforge"};
  for (const auto& [name, text] : DoorWords(door)) SetAttribute(words, name.c_str(), text);
  XmlElement& latch = AddElement(words, "latch");
  for (const auto& [name, text] : LatchWords(door.latch)) SetAttribute(latch, name.c_str(), text);
  XmlElement& grasp = AddElement(words, "grasp");
  SetAttribute(grasp, "link", door.links[kHandleLink].name);
  SetAttribute(grasp, "xyz", Decimals(door.handle_from_grasp.translation()));
  SetAttribute(grasp, "rpy", Decimals(RpyOf(door.handle_from_grasp.linear())));
  SetAttribute(grasp, "half_extent", Decimals(door.grasp_half_extent_m));
  XmlElement& labels = AddElement(words, "labels");
  for (const DoorLinkIndex link : {kBaseLink, kLeafLink, kHandleLink})
    SetAttribute(labels, door.links[link].name.c_str(), internal::LabelOf(link));
  return words;
}

// Before the end of the root element.
void Insert(const XmlElement& element, std::string& urdf) {
  const std::string printed = internal::Printed(element);
  urdf.insert(urdf.rfind("</robot>"), printed.substr(printed.find('\n') + 1));
}

}  // namespace

std::string ToExportedUrdf(const DoorAsset& door, const ExportSettings& settings) {
  UrdfModel model = ToUrdfModel(door);
  std::optional<LatchBodies> latch;
  if (settings.latch == LatchExport::kBolt) latch = internal::LatchBodiesOf(door);
  if (latch) AddLatch(*latch, door, model);
  std::string urdf = ToUrdf(model);
  Insert(ControlOf(model), urdf);
  Insert(WordsOf(door), urdf);
  return urdf;
}

namespace internal {

void WriteUrdf(const DoorAsset& door, const ExportSettings& settings,
               const std::filesystem::path& folder) {
  CommitFile(folder / "model.urdf", ToExportedUrdf(door, settings));
}

}  // namespace internal
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"
#include "doorforge/exporters/export_door.h"

#include "door_formats.h"
#include "export_text.h"

namespace doorforge {
namespace {

using internal::AddElement;
using internal::AddText;
using internal::Decimal;
using internal::Decimals;
using internal::SetAttribute;
using internal::XmlElement;

std::string Pose(const RigidTransform& pose) {
  Eigen::VectorXd numbers(6);
  numbers << pose.translation(), RpyOf(pose.linear());
  return Decimals(numbers);
}

void AddMesh(const char* kind, const std::string& name, const std::string& file,
             const Eigen::Vector4d* color, XmlElement& link) {
  XmlElement& shape = AddElement(link, kind);
  SetAttribute(shape, "name", name);
  AddText(AddElement(AddElement(shape, "geometry"), "mesh"), "uri", file);
  if (color == nullptr) return;
  XmlElement& material = AddElement(shape, "material");
  AddText(material, "ambient", Decimals(*color));
  AddText(material, "diffuse", Decimals(*color));
}

void AddSdfInertial(const MassProperties& mass, XmlElement& link) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  XmlElement& inertial = AddElement(link, "inertial");
  AddText(inertial, "pose", Pose(Translation(mass.center_of_mass_m)));
  AddText(inertial, "mass", Decimal(mass.mass_kg));
  XmlElement& inertia = AddElement(inertial, "inertia");
  AddText(inertia, "ixx", Decimal(i(0, 0)));
  AddText(inertia, "ixy", Decimal(i(0, 1)));
  AddText(inertia, "ixz", Decimal(i(0, 2)));
  AddText(inertia, "iyy", Decimal(i(1, 1)));
  AddText(inertia, "iyz", Decimal(i(1, 2)));
  AddText(inertia, "izz", Decimal(i(2, 2)));
}

// `placed_by` is the joint whose frame the link's frame is, or nothing for the root.
void AddLink(const DoorLink& link, const DoorJoint* placed_by, XmlElement& model) {
  XmlElement& element = AddElement(model, "link");
  SetAttribute(element, "name", link.name);
  if (placed_by != nullptr)
    SetAttribute(AddText(element, "pose", "0 0 0 0 0 0"), "relative_to", placed_by->name);
  AddSdfInertial(link.mass, element);
  for (const DoorGeometry& geometry : link.geometry) {
    // the mesh of an author brings its own materials
    if (geometry.visual.empty())
      AddMesh("visual", geometry.name, VisualMeshPath(geometry), &geometry.color_rgba, element);
    else
      AddMesh("visual", geometry.name, AuthoredMeshPath(geometry), nullptr, element);
    for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
      AddMesh("collision", geometry.name + "_" + std::to_string(i), CollisionMeshPath(geometry, i),
              nullptr, element);
  }
}

/// A joint with what stands around it.
struct SdfConnection {
  const DoorJoint& joint;
  const std::string& parent;
  const std::string& child;
  double spring_nm_per_rad;
};

void AddJoint(const SdfConnection& connection, XmlElement& model) {
  const DoorJoint& joint = connection.joint;
  XmlElement& element = AddElement(model, "joint");
  SetAttribute(element, "name", joint.name);
  SetAttribute(element, "type", internal::Turns(joint) ? "revolute" : "fixed");
  SetAttribute(AddText(element, "pose", Pose(joint.parent_from_child_at_zero)), "relative_to",
               connection.parent);
  AddText(element, "parent", connection.parent);
  AddText(element, "child", connection.child);
  if (!internal::Turns(joint)) return;
  XmlElement& axis = AddElement(element, "axis");
  AddText(axis, "xyz", Decimals(joint.axis));
  XmlElement& limit = AddElement(axis, "limit");
  AddText(limit, "lower", Decimal(joint.lower_rad));
  AddText(limit, "upper", Decimal(joint.upper_rad));
  AddText(limit, "effort", Decimal(joint.effort_limit_nm));
  AddText(limit, "velocity", Decimal(joint.velocity_limit_rad_s));
  XmlElement& dynamics = AddElement(axis, "dynamics");
  AddText(dynamics, "damping", Decimal(joint.damping_nm_s));
  AddText(dynamics, "spring_reference", "0");
  AddText(dynamics, "spring_stiffness", Decimal(connection.spring_nm_per_rad));
}

void AddAnchor(const std::string& base, XmlElement& model) {
  XmlElement& joint = AddElement(model, "joint");
  SetAttribute(joint, "name", "world_joint");
  SetAttribute(joint, "type", "fixed");
  AddText(joint, "parent", "world");
  AddText(joint, "child", base);
}

void AddLatch(const DoorAsset& door, XmlElement& model) {
  XmlElement& latch = AddElement(model, "doorforge:latch");
  AddText(latch, "type", std::string(NameOf(door.latch.type)));
  AddText(latch, "unlock_angle_rad", Decimal(door.latch.unlock_angle_rad));
  AddText(latch, "handle_done_angle_rad", Decimal(door.latch.handle_done_angle_rad));
  AddText(latch, "lock_effort_nm", Decimal(door.latch.lock_effort_nm));
  AddText(latch, "relatch", door.latch.relatch ? "true" : "false");
  AddText(latch, "bolt_throw_m", Decimal(door.latch.bolt_throw_m));
}

}  // namespace

std::string ToSdf(const DoorAsset& door) {
  XmlElement root{.name = "sdf"};
  SetAttribute(root, "version", "1.9");
  SetAttribute(root, "xmlns:doorforge", "https://doorforge.invalid/sdf");
  XmlElement& model = AddElement(root, "model");
  SetAttribute(model, "name", door.id);
  SetAttribute(model, "canonical_link", door.links[kBaseLink].name);
  const auto& links = door.links;
  AddLink(links[kBaseLink], nullptr, model);
  AddLink(links[kLeafLink], &door.hinge, model);
  AddLink(links[kHandleLink], &door.handle_joint, model);
  AddAnchor(links[kBaseLink].name, model);
  AddJoint({door.hinge, links[kBaseLink].name, links[kLeafLink].name,
            door.latch.hinge_spring_nm_per_rad},
           model);
  AddJoint({door.handle_joint, links[kLeafLink].name, links[kHandleLink].name,
            door.latch.handle_spring_nm_per_rad},
           model);
  AddLatch(door, model);
  return internal::Printed(root);
}

std::string ToSdfConfig(const DoorAsset& door) {
  XmlElement model{.name = "model"};
  AddText(model, "name", door.id);
  AddText(model, "version", "1.0");
  SetAttribute(AddText(model, "sdf", "model.sdf"), "version", "1.9");
  AddText(model, "description",
          "A door of body " + door.body.id + " and handle " + door.handle.id + ", " + door.license);
  return internal::Printed(model);
}

namespace internal {

void WriteSdf(const DoorAsset& door, const std::filesystem::path& folder) {
  CommitFile(folder / "model.sdf", ToSdf(door));
  CommitFile(folder / "model.config", ToSdfConfig(door));
}

}  // namespace internal
}  // namespace doorforge

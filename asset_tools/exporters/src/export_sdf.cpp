// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "doorforge/core/committed_file.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/schemas/door_words.h"

#include "door_formats.h"
#include "export_text.h"
#include "latch_bodies.h"

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

XmlElement& AddMesh(const char* kind, const std::string& name, const std::string& file,
                    XmlElement& link) {
  XmlElement& shape = AddElement(link, kind);
  SetAttribute(shape, "name", name);
  AddText(AddElement(AddElement(shape, "geometry"), "mesh"), "uri", file);
  return shape;
}

void AddColor(const Eigen::Vector4d& color, XmlElement& visual) {
  XmlElement& material = AddElement(visual, "material");
  AddText(material, "ambient", Decimals(color));
  AddText(material, "diffuse", Decimals(color));
}

// What the pixels of a visual mean, as Gazebo's segmentation camera reads it.
void AddLabel(PointLabel label, XmlElement& visual) {
  XmlElement& plugin = AddElement(visual, "plugin");
  SetAttribute(plugin, "filename", "gz-sim-label-system");
  SetAttribute(plugin, "name", "gz::sim::systems::Label");
  AddText(plugin, "label", std::to_string(static_cast<int>(label) + 1));  // 0 is the background
}

/// Shapes touch those with a common bit: the links of a door none of each other, as they overlap at
/// hinge and rose, bolt and strike each other, and all of them everything else.
enum ContactBits : int { kFrameBit = 1, kLeafBit = 2, kHandleBit = 4, kLatchBit = 8 };

void AddContact(int bits, double friction, XmlElement& collision) {
  XmlElement& surface = AddElement(collision, "surface");
  AddText(AddElement(surface, "contact"), "collide_bitmask", std::to_string(bits));
  XmlElement& ode = AddElement(AddElement(surface, "friction"), "ode");
  AddText(ode, "mu", Decimal(friction));
  AddText(ode, "mu2", Decimal(friction));
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

void AddVisuals(const DoorLink& link, bool labelled, XmlElement& element) {
  for (const DoorGeometry& geometry : link.geometry) {
    // the mesh of an author brings its own materials
    const bool authored = !geometry.visual.empty();
    XmlElement& visual =
        AddMesh("visual", geometry.name,
                authored ? AuthoredMeshPath(geometry) : VisualMeshPath(geometry), element);
    if (!authored) AddColor(geometry.color_rgba, visual);
    if (labelled) AddLabel(geometry.label, visual);
  }
}

constexpr double kFriction = 1;  // of what touches; the latch has its own

// Without bits where everything may touch everything.
void AddCollisions(const DoorLink& link, int bits, XmlElement& element) {
  for (const DoorGeometry& geometry : link.geometry) {
    for (std::size_t i = 0; i < geometry.hulls.size(); ++i) {
      XmlElement& collision = AddMesh("collision", geometry.name + "_" + std::to_string(i),
                                      CollisionMeshPath(geometry, i), element);
      if (bits != 0) AddContact(bits, kFriction, collision);
    }
  }
}

// `placed_by` is the name of the joint whose frame the link's frame is, or null for the root.
XmlElement& AddLink(const std::string& name, const MassProperties& mass, const char* placed_by,
                    XmlElement& model) {
  XmlElement& element = AddElement(model, "link");
  SetAttribute(element, "name", name);
  if (placed_by != nullptr)
    SetAttribute(AddText(element, "pose", "0 0 0 0 0 0"), "relative_to", placed_by);
  AddSdfInertial(mass, element);
  return element;
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

// SDF's own word, which came with 1.11 and which older readers pass over, and Drake's.
void AddMimic(const std::string& leader, double multiplier, XmlElement& joint, XmlElement& axis) {
  XmlElement& mimic = AddElement(axis, "mimic");
  SetAttribute(mimic, "joint", leader);
  AddText(mimic, "multiplier", Decimal(multiplier));
  AddText(mimic, "offset", "0");
  AddText(mimic, "reference", "0");
  XmlElement& drake = AddElement(joint, "drake:mimic");
  SetAttribute(drake, "joint", leader);
  SetAttribute(drake, "multiplier", Decimal(multiplier));
  SetAttribute(drake, "offset", "0");
}

void AddBoltJoint(const Bolt& bolt, const DoorAsset& door, XmlElement& model) {
  const std::string& leaf = door.links[kLeafLink].name;
  XmlElement& element = AddElement(model, "joint");
  SetAttribute(element, "name", internal::kBoltJoint);
  SetAttribute(element, "type", "prismatic");
  SetAttribute(AddText(element, "pose", Pose(bolt.leaf_from_bolt)), "relative_to", leaf);
  AddText(element, "parent", leaf);
  AddText(element, "child", internal::kBoltLink);
  XmlElement& axis = AddElement(element, "axis");
  AddText(axis, "xyz", "0 1 0");
  XmlElement& limit = AddElement(axis, "limit");
  AddText(limit, "lower", Decimal(-bolt.travel_m));
  AddText(limit, "upper", "0");
  AddText(limit, "effort", Decimal(internal::kBoltForce));
  AddText(limit, "velocity", Decimal(internal::kBoltSpeed));
  AddText(AddElement(axis, "dynamics"), "damping", Decimal(bolt.damping_n_s_m));
  AddMimic(door.handle_joint.name, -bolt.travel_m_per_rad, element, axis);
}

void AddBolt(const internal::LatchBodies& latch, const DoorAsset& door, XmlElement& model) {
  const Bolt& bolt = latch.bolt;
  XmlElement& link =
      AddLink(internal::kBoltLink, internal::BoltMass(bolt), internal::kBoltJoint, model);
  AddColor({0.75, 0.75, 0.78, 1}, AddMesh("visual", "bolt", internal::kBoltMeshPath, link));
  AddContact(kLatchBit, bolt.friction, AddMesh("collision", "bolt", internal::kBoltMeshPath, link));
  AddBoltJoint(bolt, door, model);
}

// The frame's own shapes; the strike touches the bolt alone.
void AddFrameCollisions(const internal::LatchBodies& latch, XmlElement& base) {
  for (const internal::FramePiece& piece : latch.frame) {
    const bool strike = piece.file == internal::kStrikeMeshPath;
    AddContact(strike ? kLatchBit : kFrameBit, strike ? latch.bolt.friction : kFriction,
               AddMesh("collision", piece.name, piece.file, base));
  }
}

// Drake has groups in place of bits: the bolt and what carries it would touch as others do.
void AddDrakeFilters(const DoorAsset& door, XmlElement& model) {
  const auto add = [&](const std::string& name, const std::vector<std::string>& members) {
    XmlElement& group = AddElement(model, "drake:collision_filter_group");
    SetAttribute(group, "name", name);
    for (const std::string& member : members) AddText(group, "drake:member", member);
    AddText(group, "drake:ignored_collision_filter_group", name);
  };
  const auto& links = door.links;
  add("links", {links[kBaseLink].name, links[kLeafLink].name, links[kHandleLink].name});
  add("bolt_in_leaf", {links[kLeafLink].name, links[kHandleLink].name, internal::kBoltLink});
}

void AddLatchData(const DoorAsset& door, XmlElement& model) {
  XmlElement& latch = AddElement(model, "doorforge:latch");
  for (const auto& [name, text] : LatchWords(door.latch)) AddText(latch, name.c_str(), text);
  XmlElement& words = AddElement(model, "doorforge:door");
  for (const auto& [name, text] : DoorWords(door)) AddText(words, name.c_str(), text);
  AddText(words, "grasp_half_extent_m", Decimals(door.grasp_half_extent_m));
}

void AddGraspFrame(const DoorAsset& door, XmlElement& model) {
  XmlElement& frame = AddElement(model, "frame");
  SetAttribute(frame, "name", "grasp");
  SetAttribute(frame, "attached_to", door.links[kHandleLink].name);
  AddText(frame, "pose", Pose(door.handle_from_grasp));
}

void AddLinks(const DoorAsset& door, const internal::LatchBodies* latch, XmlElement& model) {
  const std::array<const char*, 3> placed_by = {nullptr, door.hinge.name.c_str(),
                                                door.handle_joint.name.c_str()};
  const std::array<int, 3> bits = {kFrameBit, kLeafBit, kHandleBit};
  for (std::size_t i = 0; i < door.links.size(); ++i) {
    XmlElement& link = AddLink(door.links[i].name, door.links[i].mass, placed_by[i], model);
    AddVisuals(door.links[i], true, link);
    if (latch != nullptr && i == kBaseLink)
      AddFrameCollisions(*latch, link);
    else
      AddCollisions(door.links[i], latch != nullptr ? bits[i] : 0, link);
  }
}

bool HasBolt(const DoorAsset& door, const ExportSettings& settings) {
  return settings.latch == LatchExport::kBolt && door.latch.type != LatchType::kNone &&
         internal::Turns(door.handle_joint);
}

}  // namespace

std::string ToSdf(const DoorAsset& door, const ExportSettings& settings) {
  std::optional<internal::LatchBodies> latch;
  if (HasBolt(door, settings)) latch = internal::LatchBodiesOf(door);
  XmlElement root{.name = "sdf"};
  SetAttribute(root, "version", "1.9");
  SetAttribute(root, "xmlns:doorforge", "https://doorforge.invalid/sdf");
  if (latch) SetAttribute(root, "xmlns:drake", "http://drake.mit.edu");
  XmlElement& model = AddElement(root, "model");
  const auto& links = door.links;
  SetAttribute(model, "name", door.id);
  SetAttribute(model, "canonical_link", links[kBaseLink].name);
  if (latch) AddText(model, "self_collide", "true");
  AddLinks(door, latch ? &*latch : nullptr, model);
  if (latch) AddBolt(*latch, door, model);
  AddAnchor(links[kBaseLink].name, model);
  AddJoint({door.hinge, links[kBaseLink].name, links[kLeafLink].name,
            door.latch.hinge_spring_nm_per_rad},
           model);
  AddJoint({door.handle_joint, links[kLeafLink].name, links[kHandleLink].name,
            door.latch.handle_spring_nm_per_rad},
           model);
  AddGraspFrame(door, model);
  if (latch) AddDrakeFilters(door, model);
  AddLatchData(door, model);
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

void WriteSdf(const DoorAsset& door, const ExportSettings& settings,
              const std::filesystem::path& folder) {
  CommitFile(folder / "model.sdf", ToSdf(door, settings));
  CommitFile(folder / "model.config", ToSdfConfig(door));
}

}  // namespace internal
}  // namespace doorforge

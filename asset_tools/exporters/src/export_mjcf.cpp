// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "doorforge/core/committed_file.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/schemas/bolt.h"
#include "doorforge/schemas/door_words.h"

#include "door_formats.h"
#include "export_text.h"
#include "latch_bodies.h"

namespace doorforge {
namespace {

using internal::AddElement;
using internal::Decimal;
using internal::Decimals;
using internal::SetAttribute;
using internal::XmlElement;

// MuJoCo's constraints of the latch: settling time [s] and damping ratio, shares and width [m].
constexpr const char* kStiff = "0.005 1";
constexpr const char* kHard = "0.99 0.999 0.0001";
constexpr const char* kBoltBits = "2";

std::string Quaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return Decimals(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

std::string MeshName(const DoorGeometry& geometry, int hull) {
  return hull < 0 ? geometry.name : geometry.name + "_" + std::to_string(hull);
}

/// The latch as MJCF has it. Bolt and strike touch each other alone, by bits, so they stay where
/// the simulated world has them; Drake reads no bits, so the frame's shapes are those that the
/// mortise left.
std::optional<internal::LatchBodies> MjcfLatchOf(const DoorAsset& door,
                                                 const ExportSettings& settings) {
  if (settings.latch != LatchExport::kBolt) return std::nullopt;
  return internal::LatchBodiesInPlace(door);
}

void AddAssets(const DoorAsset& door, const internal::LatchBodies* latch, XmlElement& root) {
  XmlElement& asset = AddElement(root, "asset");
  const auto add = [&](const std::string& name, const std::string& file) {
    XmlElement& mesh = AddElement(asset, "mesh");
    SetAttribute(mesh, "name", name);
    SetAttribute(mesh, "file", file);
  };
  for (const DoorLink& link : door.links) {
    const bool cut = latch != nullptr && &link == &door.links[kBaseLink];
    for (const DoorGeometry& geometry : link.geometry) {
      add(MeshName(geometry, -1), VisualMeshPath(geometry));
      for (std::size_t i = 0; i < geometry.hulls.size() && !cut; ++i)
        add(MeshName(geometry, static_cast<int>(i)), CollisionMeshPath(geometry, i));
    }
  }
  if (latch == nullptr) return;
  for (const internal::FramePiece& piece : latch->frame) add(piece.name, piece.file);
  add("bolt", internal::kBoltMeshPath);
  add("strike", internal::kStrikeHullPath);
}

void AddDefaults(XmlElement& root) {
  XmlElement& defaults = AddElement(root, "default");
  const auto add = [&](const char* name, const char* group, const char* touches) {
    XmlElement& entry = AddElement(defaults, "default");
    SetAttribute(entry, "class", name);
    XmlElement& geom = AddElement(entry, "geom");
    SetAttribute(geom, "type", "mesh");
    SetAttribute(geom, "group", group);
    SetAttribute(geom, "contype", touches);
    SetAttribute(geom, "conaffinity", touches);
  };
  add("visual", "2", "0");
  add("collision", "3", "1");
}

void AddInertial(const MassProperties& mass, XmlElement& body) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  XmlElement& inertial = AddElement(body, "inertial");
  SetAttribute(inertial, "pos", Decimals(mass.center_of_mass_m));
  SetAttribute(inertial, "mass", Decimal(mass.mass_kg));
  Eigen::VectorXd full(6);
  full << i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2);
  SetAttribute(inertial, "fullinertia", Decimals(full));
}

void AddHullGeom(const std::string& mesh, XmlElement& body) {
  XmlElement& hull = AddElement(body, "geom");
  SetAttribute(hull, "class", "collision");
  SetAttribute(hull, "mesh", mesh);
}

void AddVisualGeoms(const DoorLink& link, XmlElement& body) {
  for (const DoorGeometry& geometry : link.geometry) {
    XmlElement& visual = AddElement(body, "geom");
    SetAttribute(visual, "class", "visual");
    SetAttribute(visual, "name", geometry.name + "_visual");
    SetAttribute(visual, "mesh", MeshName(geometry, -1));
    SetAttribute(visual, "rgba", Decimals(geometry.color_rgba));
  }
}

void AddGeoms(const DoorLink& link, XmlElement& body) {
  AddVisualGeoms(link, body);
  for (const DoorGeometry& geometry : link.geometry) {
    for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
      AddHullGeom(MeshName(geometry, static_cast<int>(i)), body);
  }
}

void AddJoint(const DoorJoint& joint, double spring, XmlElement& body) {
  if (!internal::Turns(joint)) return;
  XmlElement& element = AddElement(body, "joint");
  SetAttribute(element, "name", joint.name);
  SetAttribute(element, "type", "hinge");
  SetAttribute(element, "axis", Decimals(joint.axis));
  SetAttribute(element, "limited", "true");
  SetAttribute(element, "range", Decimals(Eigen::Vector2d(joint.lower_rad, joint.upper_rad)));
  SetAttribute(element, "damping", Decimal(joint.damping_nm_s));
  SetAttribute(element, "stiffness", Decimal(spring));
}

XmlElement& AddBody(const DoorLink& link, const RigidTransform& parent_from_link,
                    XmlElement& parent) {
  XmlElement& body = AddElement(parent, "body");
  SetAttribute(body, "name", link.name);
  SetAttribute(body, "pos", Decimals(parent_from_link.translation()));
  SetAttribute(body, "quat", Quaternion(parent_from_link.linear()));
  AddInertial(link.mass, body);
  return body;
}

// Touches only the other of the two, which has the same bit.
void AddLatchGeom(const char* name, const RigidTransform& body_from_geom, double friction,
                  XmlElement& body) {
  XmlElement& geom = AddElement(body, "geom");
  SetAttribute(geom, "class", "collision");
  SetAttribute(geom, "name", name);
  SetAttribute(geom, "mesh", name);
  SetAttribute(geom, "pos", Decimals(body_from_geom.translation()));
  SetAttribute(geom, "quat", Quaternion(body_from_geom.linear()));
  SetAttribute(geom, "contype", kBoltBits);
  SetAttribute(geom, "conaffinity", kBoltBits);
  SetAttribute(geom, "friction", Decimals(Eigen::Vector3d(friction, 0.005, 0.0001)));
  SetAttribute(geom, "solref", kStiff);
  SetAttribute(geom, "solimp", kHard);
}

void AddBoltBody(const Bolt& bolt, XmlElement& leaf) {
  XmlElement& body = AddElement(leaf, "body");
  SetAttribute(body, "name", "bolt");
  SetAttribute(body, "pos", Decimals(bolt.leaf_from_bolt.translation()));
  SetAttribute(body, "quat", Quaternion(bolt.leaf_from_bolt.linear()));
  XmlElement& inertial = AddElement(body, "inertial");
  SetAttribute(inertial, "pos", "0 0 0");
  SetAttribute(inertial, "mass", Decimal(bolt.mass_kg));
  SetAttribute(inertial, "diaginertia", "1e-5 1e-5 1e-5");
  XmlElement& joint = AddElement(body, "joint");
  SetAttribute(joint, "name", "bolt_joint");
  SetAttribute(joint, "type", "slide");
  SetAttribute(joint, "axis", "0 1 0");
  SetAttribute(joint, "limited", "true");
  SetAttribute(joint, "range", Decimals(Eigen::Vector2d(-bolt.travel_m, 0)));
  SetAttribute(joint, "damping", Decimal(bolt.damping_n_s_m));
  SetAttribute(joint, "stiffness", Decimal(bolt.stiffness_n_per_m));
  SetAttribute(joint, "springref", Decimal(bolt.preload_n / bolt.stiffness_n_per_m));
  AddLatchGeom("bolt", RigidTransform::Identity(), bolt.friction, body);
}

void AddContacts(const DoorAsset& door, const Bolt* bolt, XmlElement& root) {
  XmlElement& contact = AddElement(root, "contact");
  const auto exclude = [&](const std::string& one, const std::string& other) {
    XmlElement& element = AddElement(contact, "exclude");
    SetAttribute(element, "body1", one);
    SetAttribute(element, "body2", other);
  };
  // neighbours overlap at hinge and rose
  const auto& links = door.links;
  exclude(links[kBaseLink].name, links[kLeafLink].name);
  exclude(links[kLeafLink].name, links[kHandleLink].name);
  exclude(links[kBaseLink].name, links[kHandleLink].name);
  if (bolt == nullptr) return;
  // for readers without bits
  exclude(links[kLeafLink].name, "bolt");
  exclude(links[kHandleLink].name, "bolt");
  // for readers that look for other contacts with a margin of their own
  XmlElement& pair = AddElement(contact, "pair");
  SetAttribute(pair, "geom1", "bolt");
  SetAttribute(pair, "geom2", "strike");
  Eigen::VectorXd frictions(5);
  frictions << bolt->friction, bolt->friction, 0.005, 0.0001, 0.0001;
  SetAttribute(pair, "friction", Decimals(frictions));
  SetAttribute(pair, "solref", kStiff);
  SetAttribute(pair, "solimp", kHard);
}

// A cable: the handle pulls the bolt back, and nothing pushes the handle.
void AddCoupling(const Bolt& bolt, XmlElement& root) {
  XmlElement& cable = AddElement(AddElement(root, "tendon"), "fixed");
  SetAttribute(cable, "name", "latch");
  SetAttribute(cable, "limited", "true");
  SetAttribute(cable, "range", Decimals(Eigen::Vector2d(-1, 0)));
  // by default a cable on so light a bolt gives by millimetres
  SetAttribute(cable, "solreflimit", kStiff);
  SetAttribute(cable, "solimplimit", kHard);
  for (const auto& [joint, coefficient] :
       {std::pair{"bolt_joint", 1.0}, {"handle_joint", bolt.travel_m_per_rad}}) {
    XmlElement& element = AddElement(cable, "joint");
    SetAttribute(element, "joint", joint);
    SetAttribute(element, "coef", Decimal(coefficient));
  }
}

void AddCustom(const char* kind, const std::string& name, const std::string& data,
               XmlElement& custom) {
  XmlElement& element = AddElement(custom, kind);
  SetAttribute(element, "name", name);
  SetAttribute(element, "data", data);
}

// Numbers as MuJoCo reads them, and the words that make the door what it is.
void AddLatchWords(const DoorAsset& door, XmlElement& root) {
  XmlElement& custom = AddElement(root, "custom");
  const auto words = LatchWords(door.latch);
  for (const auto& [name, text] : words) {
    const bool number = text.find_first_not_of("0123456789.e+-") == std::string::npos;
    if (number) AddCustom("numeric", "latch_" + name, text, custom);
  }
  for (const auto& [name, text] : words) {
    const bool number = text.find_first_not_of("0123456789.e+-") == std::string::npos;
    if (!number) AddCustom("text", "latch_" + name, text, custom);
  }
  for (const auto& [name, text] : DoorWords(door)) {
    if (!text.empty())
      AddCustom("text", "door_" + name, text, custom);  // MuJoCo takes no empty one
  }
  for (const DoorLinkIndex link : {kBaseLink, kLeafLink, kHandleLink})
    AddCustom("text", "label_" + door.links[link].name, internal::LabelOf(link), custom);
}

void AddGraspSite(const DoorAsset& door, XmlElement& handle) {
  XmlElement& site = AddElement(handle, "site");
  SetAttribute(site, "name", "grasp");
  SetAttribute(site, "pos", Decimals(door.handle_from_grasp.translation()));
  SetAttribute(site, "quat", Quaternion(door.handle_from_grasp.linear()));
  if ((door.grasp_half_extent_m.array() <= 0).any()) return;  // a size must be positive
  SetAttribute(site, "type", "box");
  SetAttribute(site, "size", Decimals(door.grasp_half_extent_m));
  SetAttribute(site, "group", "4");
}

}  // namespace

std::string ToMjcf(const DoorAsset& door, const ExportSettings& settings) {
  XmlElement root{.name = "mujoco"};
  SetAttribute(root, "model", door.id);
  XmlElement& compiler = AddElement(root, "compiler");
  SetAttribute(compiler, "angle", "radian");
  SetAttribute(compiler, "inertiafromgeom", "false");
  AddLatchWords(door, root);
  AddDefaults(root);
  const std::optional<internal::LatchBodies> latch = MjcfLatchOf(door, settings);
  AddAssets(door, latch ? &*latch : nullptr, root);
  XmlElement& base =
      AddBody(door.links[kBaseLink], RigidTransform::Identity(), AddElement(root, "worldbody"));
  if (latch) {
    AddVisualGeoms(door.links[kBaseLink], base);
    for (const internal::FramePiece& piece : latch->frame) AddHullGeom(piece.name, base);
  } else {
    AddGeoms(door.links[kBaseLink], base);
  }
  XmlElement& leaf = AddBody(door.links[kLeafLink], door.hinge.parent_from_child_at_zero, base);
  AddJoint(door.hinge, door.latch.hinge_spring_nm_per_rad, leaf);
  AddGeoms(door.links[kLeafLink], leaf);
  XmlElement& handle =
      AddBody(door.links[kHandleLink], door.handle_joint.parent_from_child_at_zero, leaf);
  AddJoint(door.handle_joint, door.latch.handle_spring_nm_per_rad, handle);
  AddGeoms(door.links[kHandleLink], handle);
  AddGraspSite(door, handle);
  AddContacts(door, latch ? &latch->bolt : nullptr, root);
  if (latch) {
    AddBoltBody(latch->bolt, leaf);
    AddLatchGeom("strike", latch->bolt.base_from_strike, latch->bolt.friction, base);
    AddCoupling(latch->bolt, root);
  }
  return internal::Printed(root);
}

namespace internal {

void WriteMjcf(const DoorAsset& door, const ExportSettings& settings,
               const std::filesystem::path& folder) {
  CommitFile(folder / "model.xml", ToMjcf(door, settings));
}

}  // namespace internal
}  // namespace doorforge

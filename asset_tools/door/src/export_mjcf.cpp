// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/door/export_door.h"

#include "export_text.h"

namespace doorforge {
namespace {

using internal::AddElement;
using internal::Decimal;
using internal::Decimals;
using internal::SetAttribute;
using internal::XmlElement;

constexpr double kBoltHalfWidth = 0.006;  // [m]
constexpr double kBoltInLeaf = 0.02;      // [m] behind the leaf's edge
constexpr double kStrikePlay = 0.001;     // [m] between bolt and strike
constexpr double kStrikeGap = 0.1;        // of the throw, between the leaf's edge and the strike
constexpr double kBoltMass = 0.05;        // [kg]
constexpr double kBoltDamping = 5;        // [N s/m] a stiff coupling on a light bolt rings without
constexpr double kDefaultThrow = 0.012;   // [m] where the latch is the effort law

std::string Quaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return Decimals(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

std::string MeshName(const DoorGeometry& geometry, int hull) {
  return hull < 0 ? geometry.name : geometry.name + "_" + std::to_string(hull);
}

void AddAssets(const DoorAsset& door, XmlElement& root) {
  XmlElement& asset = AddElement(root, "asset");
  const auto add = [&](const std::string& name, const std::string& file) {
    XmlElement& mesh = AddElement(asset, "mesh");
    SetAttribute(mesh, "name", name);
    SetAttribute(mesh, "file", file);
  };
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      add(MeshName(geometry, -1), VisualMeshPath(geometry));
      for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
        add(MeshName(geometry, static_cast<int>(i)), CollisionMeshPath(geometry, i));
    }
  }
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

void AddGeoms(const DoorLink& link, XmlElement& body) {
  for (const DoorGeometry& geometry : link.geometry) {
    XmlElement& visual = AddElement(body, "geom");
    SetAttribute(visual, "class", "visual");
    SetAttribute(visual, "name", geometry.name + "_visual");
    SetAttribute(visual, "mesh", MeshName(geometry, -1));
    SetAttribute(visual, "rgba", Decimals(geometry.color_rgba));
    for (std::size_t i = 0; i < geometry.hulls.size(); ++i) {
      XmlElement& hull = AddElement(body, "geom");
      SetAttribute(hull, "class", "collision");
      SetAttribute(hull, "mesh", MeshName(geometry, static_cast<int>(i)));
    }
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

/// The bolt and its strike, in the leaf's frame.
struct Bolt {
  Eigen::Vector3d edge;     ///< On the leaf's free edge, at the handle's height.
  Eigen::Vector3d outward;  ///< Out of the edge: the bolt's way.
  Eigen::Vector3d opens;    ///< The way the edge goes as the door opens.
  double throw_m;
  double travel_per_rad;
};

Bolt BoltOf(const DoorAsset& door) {
  const Eigen::AlignedBox3d leaf = internal::LeafBounds(door);
  const bool left = door.hinge_side == HingeSide::kLeft;
  const Eigen::Vector3d handle = door.handle_joint.parent_from_child_at_zero.translation();
  Bolt bolt;
  bolt.outward = left ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, -1, 0);
  bolt.opens =
      door.opening == Opening::kPull ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(-1, 0, 0);
  bolt.edge = {leaf.center().x(), left ? leaf.max().y() : leaf.min().y(), handle.z()};
  bolt.throw_m = door.latch.type == LatchType::kBolt ? door.latch.bolt_throw_m : kDefaultThrow;
  bolt.travel_per_rad = bolt.throw_m / door.latch.unlock_angle_rad;
  return bolt;
}

void AddBox(const char* name, const Eigen::Vector3d& center, const Eigen::Vector3d& half,
            XmlElement& body) {
  XmlElement& geom = AddElement(body, "geom");
  SetAttribute(geom, "name", name);
  SetAttribute(geom, "type", "box");
  SetAttribute(geom, "pos", Decimals(center));
  SetAttribute(geom, "size", Decimals(half));
  SetAttribute(geom, "group", "3");
  SetAttribute(geom, "contype", "0");
  SetAttribute(geom, "conaffinity", "0");
}

void AddBoltBody(const Bolt& bolt, XmlElement& leaf) {
  XmlElement& body = AddElement(leaf, "body");
  SetAttribute(body, "name", "bolt");
  SetAttribute(body, "pos", Decimals(bolt.edge));
  XmlElement& inertial = AddElement(body, "inertial");
  SetAttribute(inertial, "pos", "0 0 0");
  SetAttribute(inertial, "mass", Decimal(kBoltMass));
  SetAttribute(inertial, "diaginertia", "1e-5 1e-5 1e-5");
  XmlElement& joint = AddElement(body, "joint");
  SetAttribute(joint, "name", "bolt_joint");
  SetAttribute(joint, "type", "slide");
  SetAttribute(joint, "axis", Decimals(bolt.outward));
  SetAttribute(joint, "damping", Decimal(kBoltDamping));
  const double half = (bolt.throw_m + kBoltInLeaf) / 2;
  Eigen::Vector3d size = Eigen::Vector3d::Constant(kBoltHalfWidth);
  size.y() = half;
  AddBox("bolt", bolt.outward * (bolt.throw_m - half), size, body);
}

// Fixed to the frame, beside the leaf's edge, in the bolt's way.
void AddStrike(const DoorAsset& door, const Bolt& bolt, XmlElement& base) {
  const double gap = kStrikeGap * bolt.throw_m;
  const double depth = bolt.throw_m + 0.01 - gap;
  constexpr double kHalfThickness = 0.01;
  const Eigen::Vector3d center = bolt.edge + bolt.outward * (gap + depth / 2) +
                                 bolt.opens * (kBoltHalfWidth + kStrikePlay + kHalfThickness);
  AddBox("strike", door.hinge.parent_from_child_at_zero * center,
         {kHalfThickness, depth / 2, 3 * kBoltHalfWidth}, base);
}

void AddContacts(const DoorAsset& door, bool bolted, XmlElement& root) {
  XmlElement& contact = AddElement(root, "contact");
  // neighbours overlap at hinge and rose
  for (const auto& [a, b] :
       {std::pair{kBaseLink, kLeafLink}, {kLeafLink, kHandleLink}, {kBaseLink, kHandleLink}}) {
    XmlElement& exclude = AddElement(contact, "exclude");
    SetAttribute(exclude, "body1", door.links[a].name);
    SetAttribute(exclude, "body2", door.links[b].name);
  }
  if (!bolted) return;
  XmlElement& pair = AddElement(contact, "pair");
  SetAttribute(pair, "geom1", "bolt");
  SetAttribute(pair, "geom2", "strike");
}

void AddCoupling(const Bolt& bolt, XmlElement& root) {
  XmlElement& joint = AddElement(AddElement(root, "equality"), "joint");
  SetAttribute(joint, "name", "latch");
  SetAttribute(joint, "joint1", "bolt_joint");
  SetAttribute(joint, "joint2", "handle_joint");
  SetAttribute(joint, "polycoef", "0 " + Decimal(-bolt.travel_per_rad) + " 0 0 0");
}

void AddLatchNumbers(const DoorAsset& door, XmlElement& root) {
  XmlElement& custom = AddElement(root, "custom");
  const auto number = [&](const char* name, double value) {
    XmlElement& element = AddElement(custom, "numeric");
    SetAttribute(element, "name", name);
    SetAttribute(element, "data", Decimal(value));
  };
  number("latch_unlock_angle_rad", door.latch.unlock_angle_rad);
  number("latch_handle_done_angle_rad", door.latch.handle_done_angle_rad);
  number("latch_lock_effort_nm", door.latch.lock_effort_nm);
  XmlElement& type = AddElement(custom, "text");
  SetAttribute(type, "name", "latch_type");
  SetAttribute(type, "data", std::string(NameOf(door.latch.type)));
}

}  // namespace

std::string ToMjcf(const DoorAsset& door) {
  XmlElement root{.name = "mujoco"};
  SetAttribute(root, "model", door.id);
  XmlElement& compiler = AddElement(root, "compiler");
  SetAttribute(compiler, "angle", "radian");
  SetAttribute(compiler, "inertiafromgeom", "false");
  AddLatchNumbers(door, root);
  AddDefaults(root);
  AddAssets(door, root);
  const bool bolted = door.latch.type != LatchType::kNone && internal::Turns(door.handle_joint);
  XmlElement& base =
      AddBody(door.links[kBaseLink], RigidTransform::Identity(), AddElement(root, "worldbody"));
  AddGeoms(door.links[kBaseLink], base);
  XmlElement& leaf = AddBody(door.links[kLeafLink], door.hinge.parent_from_child_at_zero, base);
  AddJoint(door.hinge, door.latch.hinge_spring_nm_per_rad, leaf);
  AddGeoms(door.links[kLeafLink], leaf);
  XmlElement& handle =
      AddBody(door.links[kHandleLink], door.handle_joint.parent_from_child_at_zero, leaf);
  AddJoint(door.handle_joint, door.latch.handle_spring_nm_per_rad, handle);
  AddGeoms(door.links[kHandleLink], handle);
  AddContacts(door, bolted, root);
  if (bolted) {
    const Bolt bolt = BoltOf(door);
    AddBoltBody(bolt, leaf);
    AddStrike(door, bolt, base);
    AddCoupling(bolt, root);
  }
  return internal::Printed(root);
}

}  // namespace doorforge

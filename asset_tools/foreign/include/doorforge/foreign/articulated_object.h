// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Where something stands in a file from outside.
struct SourcePlace {
  std::string file;     ///< Path as it was given.
  int line = 0;         ///< From 1; 0 where the format has no lines.
  int column = 0;       ///< From 1, in bytes; 0 likewise.
  std::string element;  ///< XPath, prim path or JSON pointer; may be empty.
};

struct ForeignMeshFile {
  std::string name;  ///< It is as written; schemes such as "package://" are kept.
  Eigen::Vector3d scale{1, 1, 1};
};
struct ForeignBox {
  Eigen::Vector3d size_m;
};
struct ForeignCylinder {
  double radius_m;
  double length_m;  ///< Along z, centred; of a capsule without its caps.
};
struct ForeignSphere {
  double radius_m;
};
/// The last holds triangles that lie in the file itself; the first is a shape that no rule
/// measures.
using ForeignGeometry = std::variant<std::monostate, ForeignMeshFile, ForeignBox, ForeignCylinder,
                                     ForeignSphere, TriangleMesh>;

enum class ShapeUse { kVisual, kCollision, kBoth };

struct ForeignShape {
  std::string name;
  ShapeUse use = ShapeUse::kVisual;
  bool as_hull = false;  ///< It collides as its convex hull, and need not be closed.
  RigidTransform link_from_shape = RigidTransform::Identity();
  ForeignGeometry geometry;
  SourcePlace place;
};

struct ForeignInertial {
  double mass_kg = 0;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();  ///< In the link's frame.
  /// About the centre, in the link's axes [kg m2]; absent where the format computes it.
  std::optional<Eigen::Matrix3d> inertia_kg_m2;
  SourcePlace place;
  SourcePlace mass_place;
  SourcePlace inertia_place;
};

struct ForeignLink {
  std::string name;
  std::optional<ForeignInertial> inertial;
  std::vector<ForeignShape> shapes;
  SourcePlace place;
};

enum class ForeignJointType { kFixed, kRevolute, kContinuous, kPrismatic, kOther };

struct ForeignMimic {
  std::string joint;
  double multiplier = 1;
  SourcePlace place;
};

/// Limits in radians or metres; each is absent where the file does not state it.
struct ForeignLimit {
  std::optional<double> lower;
  std::optional<double> upper;
  std::optional<double> effort;
  std::optional<double> velocity;
  SourcePlace place;
};

struct ForeignJoint {
  std::string name;
  ForeignJointType type = ForeignJointType::kFixed;
  std::string parent;  ///< Empty: the world.
  std::string child;
  RigidTransform parent_from_joint = RigidTransform::Identity();  ///< And the child, at zero.
  RigidTransform child_from_joint = RigidTransform::Identity();
  std::optional<Eigen::Vector3d> axis;  ///< In the joint's frame, as written.
  std::optional<ForeignLimit> limit;
  std::optional<double> damping;
  std::optional<double> friction;
  std::optional<ForeignMimic> mimic;
  SourcePlace place;
  SourcePlace axis_place;
  SourcePlace dynamics_place;
};

/// A file that the object names beside its meshes: a texture, an include.
struct ForeignFileName {
  std::string name;
  SourcePlace place;
  bool optional = false;  ///< The object loads without it.
};

/// What a format asks for; what it does not ask for may be absent.
struct FormatTraits {
  bool one_root = false;      ///< Links form one tree.
  bool needs_limits = false;  ///< Revolute and prismatic joints have limits with effort, velocity.
  bool unit_axes = false;     ///< Readers take an axis as it is.
  bool needs_masses = false;  ///< Mass is not computed from shapes.
};

/// What a USD stage says beside links and joints; names are prim paths.
struct StageFacts {
  double unit_m = 0.01;
  std::string default_prim;
  std::size_t articulations = 0;
  std::set<std::string> labelled;     ///< They have SemanticsLabelsAPI.
  std::set<std::string> with_extent;  ///< Meshes.
};

/// An object of links and joints from outside, as far as its file can be read. Names are as written
/// and may be empty or occur twice: it is what is judged, and promises nothing.
struct ArticulatedObject {
  std::string name;
  std::vector<ForeignLink> links;
  std::vector<ForeignJoint> joints;
  std::vector<ForeignFileName> files;
  FormatTraits traits;
  SourcePlace place;
  bool y_up = false;  ///< The y axis of its world points up, not z.
  StageFacts stage = {};
  std::set<std::string> paired = {};  ///< Shapes that touch by a pair of MJCF, by name.
};

}  // namespace doorforge

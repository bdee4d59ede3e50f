// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/foreign/articulated_object.h"
#include "doorforge/foreign/validate_foreign.h"

namespace doorforge {

/// How much of an object is drawn.
struct DrawSettings {
  std::size_t most_triangles = 60'000;  ///< Of all shapes; larger meshes are drawn coarser.
  std::size_t most_edges = 2'000;       ///< Of one finding.
};

struct DrawnLink {
  std::string name;
  RigidTransform world_from_link;  ///< With all joints at zero; z is up.
};

struct DrawnShape {
  std::string name;
  std::size_t link = 0;
  ShapeUse use = ShapeUse::kVisual;
  RigidTransform link_from_shape;
  TriangleMesh mesh;  ///< In the shape's frame [m], with its scale.
};

/// A joint whose ends are there. Parent and child are places in DrawnObject::links; a joint of the
/// world has no parent.
struct DrawnJoint {
  std::string name;
  ForeignJointType type = ForeignJointType::kFixed;
  std::optional<std::size_t> parent;
  std::size_t child = 0;
  RigidTransform parent_from_joint;
  RigidTransform child_from_joint;
  Eigen::Vector3d axis;  ///< In the joint's frame; of unit length where the file gives a direction.
  double lower = 0;      ///< [rad] or [m]; with `upper` half a turn or 0 where the file has none.
  double upper = 0;
};

/// Where a finding lies on the object, as places in its lists; all empty where it is about the file
/// as a whole.
struct FindingMark {
  std::optional<std::size_t> link;
  std::optional<std::size_t> joint;
  std::optional<std::size_t> shape;
  std::optional<Eigen::Vector3d> point_m;  ///< In the link's frame.
  /// Edges of the triangles that the finding is about, in the shape's frame.
  std::vector<std::array<Eigen::Vector3d, 2>> edges;
};

/// What can be drawn of a file from outside.
struct DrawnObject {
  std::vector<DrawnLink> links;
  std::vector<DrawnShape> shapes;
  std::vector<DrawnJoint> joints;
  std::vector<FindingMark> marks;     ///< By finding of the report.
  std::vector<std::string> left_out;  ///< What is not drawn, or drawn coarser; for people.
};

/// Reads the file of a report of ForeignValidator again, and marks the report's findings: by the
/// element that each names, and of those about triangles (GEO009 to GEO012, GEO017) by the edges
/// themselves. What cannot be read is left out; nothing is thrown for what the file holds.
/// `searched` is as in ForeignValidator::Validate(). Other programs are not asked.
/// Deterministic; for several threads.
DrawnObject DrawForeignFile(const ValidationReport& report, const ForeignChecks& checks,
                            const std::filesystem::path& searched = {},
                            const DrawSettings& settings = {});

}  // namespace doorforge

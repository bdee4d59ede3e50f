// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "recipe_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/parts/grasp.h"

namespace doorforge {
namespace {

constexpr double kAny = 9;
constexpr std::size_t kMostHulls = 32;
constexpr double kMostOffCenterM = 0.0018;
constexpr double kMostWidthM = 0.0755;  // an 80 mm gripper needs some room
constexpr double kGapMarginM = 0.0045;

/// The limits bound the bounding box (x, y, z), the way from hinge to mount, and the leaf's mass.
struct Limits {
  Eigen::Vector3d least_m = {0, 0, 0};
  Eigen::Vector3d most_m = {kAny, kAny, kAny};
  double least_reach_m = 0;
  double most_reach_m = kAny;
  double least_kg = 0;
  double most_kg = 25;
};

// The ranges measured on the released objects, docs/catalogue.md.
Limits BodyLimits(const Part& part) {
  switch (part.category) {
    case Category::kInterior:
      return {{0, 0, 1.70}, {kAny, kAny, 1.90}, 0.51, 0.889, 8};
    case Category::kWindow:
      return {{0, 0.63, 0.625}, {0.175, 1.365, 1.65}, 0.444, 0.895};
    case Category::kCar:
      if (FindPiece(part, "frame") == nullptr) return {{}, {kAny, kAny, 1.96}, 0.73, 1.1};
      return {{1.57, 3.999, 0}, {1.99, 4.001, 1.96}, 0.73, 1.1};
    case Category::kSafe:
      return {{0.205, 0.356, 0.49}, {0.938, 0.91, 1.069}, 0, kAny, 5, 200};
    case Category::kStorageFurniture:
      return {{0.309, 0.531, 0.594}, {0.95, 1.425, 1.242}, 0.474, 1.299, 5};
    case Category::kRefrigerator:
      return {{0.388, 0.45, 1.013}, {0.748, 1.02, 1.51}, 0, kAny, 5};
  }
  return {};
}

Limits HandleLimits(const Part& part) {
  switch (part.category) {
    case Category::kInterior:
      if (part.mechanism == Mechanism::kLever) return {{0, 0.13, 0}, {0.103, 0.17, kAny}};
      return {{}, {0.103, 0.068, kAny}};
    case Category::kWindow:
      return {{0, 0, 0.148}, {kAny, kAny, 0.1795}};
    case Category::kCar:
      return {{0, 0.1855, 0}, {kAny, 0.2145, kAny}};
    case Category::kSafe:
      return {{0.009, 0.102, 0.061}, {0.08, 0.253, 0.212}};
    case Category::kStorageFurniture:
      if (part.mechanism == Mechanism::kRound) return {{}, {0.103, 0.068, 0.068}};
      return {{}, {0.103, kAny, kAny}};
    case Category::kRefrigerator:
      return {{0.038, 0.112, 0.04}, {0.059, 0.145, 0.07}};
  }
  return {};
}

Eigen::AlignedBox3d BoundsOf(const Part& part) {
  Eigen::AlignedBox3d box;
  for (const PartPiece& piece : part.pieces) {
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices) box.extend(vertex);
  }
  return box;
}

std::string SizeFault(const Part& part) {
  constexpr double kSlackM = 5e-4;
  const bool body = part.role == PartRole::kBody;
  const Limits limits = body ? BodyLimits(part) : HandleLimits(part);
  const Eigen::Array3d size = BoundsOf(part).sizes().array();
  if ((size < limits.least_m.array() - kSlackM).any() ||
      (size > limits.most_m.array() + kSlackM).any())
    return "size " + std::to_string(size.x()) + " " + std::to_string(size.y()) + " " +
           std::to_string(size.z());
  if (!body) return {};
  const double reach = part.part_from_mount.translation().y() - part.joint.origin_m.y();
  if (reach < limits.least_reach_m || reach > limits.most_reach_m)
    return "reach " + std::to_string(reach);
  const double mass_kg = FindPiece(part, "leaf")->mass.mass_kg;
  if (mass_kg < limits.least_kg || mass_kg > limits.most_kg)
    return "leaf of " + std::to_string(mass_kg) + " kg";
  return {};
}

// How deep a point lies in a convex mesh; negative: outside.
double DepthIn(const TriangleMesh& hull, const Eigen::Vector3d& point) {
  double depth = kAny;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    depth = std::min(depth, -(point - a).dot((b - a).cross(c - a).normalized()));
  }
  return depth;
}

// A crank's knob and a key's neck stand where the fingers close.
bool HasFreeGap(const Part& part) {
  return part.mechanism != Mechanism::kKey && !part.id.starts_with("window_crank");
}

std::string GraspFault(const Part& part) {
  TriangleMesh handle;
  for (const PartPiece& piece : part.pieces) {
    const int offset = static_cast<int>(handle.vertices.size());
    handle.vertices.insert(handle.vertices.end(), piece.mesh.vertices.begin(),
                           piece.mesh.vertices.end());
    for (const Eigen::Vector3i& t : piece.mesh.triangles)
      handle.triangles.emplace_back(t.array() + offset);
  }
  const GraspFit fit = MeasureGrasp(FindPiece(part, "grip")->mesh, handle, part.part_from_grasp);
  if (!fit.holds || fit.width_m > kMostWidthM || std::abs(fit.off_center_m) > kMostOffCenterM)
    return "no gripper holds it";
  if (fit.tip_clearance_m < 0.002) return "the fingers meet the leaf";
  if (!HasFreeGap(part)) return {};
  Eigen::Vector3d gap = part.part_from_grasp.translation();
  gap.x() *= 0.5;
  if (part.mechanism == Mechanism::kRound) gap.z() += 0.03;
  for (const PartPiece& piece : part.pieces) {
    for (const TriangleMesh& hull : piece.hulls) {
      if (DepthIn(hull, gap) > -kGapMarginM) return "a hull fills the space behind the grip";
    }
  }
  return {};
}

bool SwingsFree(const Part& part) {
  const PartPiece* frame = FindPiece(part, "frame");
  if (frame == nullptr) return true;
  for (const double angle : {0.0, 0.02, 0.1, 0.5, 1.5}) {
    const RigidTransform swing = Translation(part.joint.origin_m) *
                                 RotationAbout(part.joint.axis, angle) *
                                 Translation(-part.joint.origin_m);
    for (const Eigen::Vector3d& vertex : FindPiece(part, "leaf")->mesh.vertices) {
      const Eigen::Vector3d at = swing * vertex;
      for (const TriangleMesh& hull : frame->hulls) {
        if (DepthIn(hull, at) > 0.0005) return false;
      }
    }
  }
  return true;
}

}  // namespace

std::string FaultOf(const Part& part) {
  for (const PartPiece& piece : part.pieces) {
    if (piece.hulls.size() > kMostHulls) return std::to_string(piece.hulls.size()) + " hulls";
  }
  std::string fault = SizeFault(part);
  if (fault.empty() && part.role == PartRole::kHandle) fault = GraspFault(part);
  return fault;
}

std::string SlowFaultOf(const Part& part) {
  const bool handle = part.role == PartRole::kHandle;
  for (const PartPiece& piece : part.pieces) {
    const ConvexPartsFit fit = MeasureConvexParts(*ClosedMesh::From(piece.mesh), piece.hulls);
    if (fit.uncovered_m > (handle ? 0.003 : 0.01)) return "hulls leave the surface uncovered";
    // the shell of a car may stand out farther in the arches of its wheels
    if (part.category != Category::kCar && fit.protrusion_m > (handle ? 0.003 : 0.017))
      return "hulls stand out by " + std::to_string(fit.protrusion_m);
  }
  if (!handle && !SwingsFree(part)) return "the leaf meets its frame";
  return {};
}

}  // namespace doorforge

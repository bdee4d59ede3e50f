// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "doorforge/core/mesh_transform.h"
#include "doorforge/parts/grasp.h"
#include "doorforge/parts/line_hits.h"

#include "check_handle_stance.h"
#include "findings.h"
#include "record_meshes.h"

namespace doorforge::internal {
namespace {

constexpr int kSurfaceSamples = 160;

// Triangle centres at equal steps of surface area.
std::vector<Eigen::Vector3d> AreaSamples(const TriangleMesh& mesh) {
  std::vector<double> area_until;
  std::vector<Eigen::Vector3d> centers;
  double area = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    area += (b - a).cross(c - a).norm() / 2;
    area_until.push_back(area);
    centers.emplace_back((a + b + c) / 3);
  }
  std::vector<Eigen::Vector3d> samples;
  for (int i = 0; i < kSurfaceSamples; ++i) {
    const double at = area * (i + 0.5) / kSurfaceSamples;
    const auto triangle = std::lower_bound(area_until.begin(), area_until.end(), at);
    samples.push_back(centers[static_cast<std::size_t>(triangle - area_until.begin())]);
  }
  return samples;
}

/// Handle and leaf in the leaf's frame.
struct MountedHandle {
  const LeafLines& leaf;
  TriangleMesh grip;
  TriangleMesh handle;  ///< Grip and rose.
  RigidTransform leaf_from_grasp;
  Eigen::Vector3d mount;
};

MountedHandle Mounted(const DoorAsset& door, const LeafLines& leaf) {
  const RigidTransform& leaf_from_handle = door.handle_joint.parent_from_child_at_zero;
  std::vector<TriangleMesh> grip;
  std::vector<TriangleMesh> handle;
  for (const DoorGeometry& geometry : door.links[kLeafLink].geometry) {
    if (geometry.label == PointLabel::kHandle) handle.push_back(geometry.mesh);
  }
  for (const DoorGeometry& geometry : door.links[kHandleLink].geometry)
    grip.push_back(Transformed(geometry.mesh, leaf_from_handle));
  handle.insert(handle.end(), grip.begin(), grip.end());
  return {leaf, Merged(grip), Merged(handle), leaf_from_handle * door.handle_from_grasp,
          leaf_from_handle.translation()};
}

// x of the leaf's outer surface in front of (y, z); nothing where the leaf has an opening.
std::optional<double> SurfaceAt(const LeafLines& leaf, const Eigen::Vector3d& point) {
  const auto hits = leaf.lines.At({point.y(), point.z()});
  if (!hits) return std::nullopt;
  return hits->last;
}

double BuriedShare(const MountedHandle& mounted) {
  constexpr double kTouchM = 0.0005;
  int inside = 0;
  for (const Eigen::Vector3d& point : AreaSamples(mounted.grip)) {
    const auto hits = mounted.leaf.lines.At({point.y(), point.z()});
    inside += hits && point.x() > hits->first + kTouchM && point.x() < hits->last - kTouchM;
  }
  return static_cast<double>(inside) / kSurfaceSamples;
}

double BeyondOutline(const MountedHandle& mounted) {
  const Eigen::AlignedBox3d& leaf = mounted.leaf.bounds;
  const Eigen::AlignedBox3d handle = BoundsOf(mounted.handle);
  double beyond = 0;
  for (const int axis : {1, 2})
    beyond = std::max(
        {beyond, leaf.min()[axis] - handle.min()[axis], handle.max()[axis] - leaf.max()[axis]});
  return beyond;
}

// Material of the grip between the pads, along the fingers' way.
std::optional<LineHits> BetweenFingers(const TriangleMesh& grip_in_grasp) {
  std::optional<LineHits> all;
  for (const double x : {-0.006, 0.0, 0.006}) {
    for (const double z : {-0.006, 0.0, 0.006}) {
      const auto hits = HitsAlong(grip_in_grasp, 1, {z, x});
      if (!hits) continue;
      all = all ? LineHits{std::min(all->first, hits->first), std::max(all->last, hits->last)}
                : *hits;
    }
  }
  return all;
}

/// A grasp in a frame whose plane x = 0 is the leaf's surface at the mount.
struct CheckedGrasp {
  std::string where;
  const TriangleMesh& grip_in_grasp;
  RigidTransform frame_from_grasp;
  double leaf_x;  ///< The leaf's surface behind the grasp; -infinity where there is none.
};

// One fault, one finding: what is asked last makes sense only where the rest holds.
Findings CheckGrasp(const CheckedGrasp& checked, const GraspMeasure& measure) {
  const GripperShape gripper;
  const Eigen::Vector3d approach = checked.frame_from_grasp.linear().col(2);
  if (-approach.x() < LimitOf("HND005"))
    return {Found("HND005", checked.where, Number(-approach.x()))};
  const auto material = BetweenFingers(checked.grip_in_grasp);
  if (!material || material->first > gripper.opening_m / 2 ||
      material->last < -gripper.opening_m / 2)
    return {Found("HND004", checked.where, "nothing between the fingers")};
  Findings findings;
  const double tips = checked.frame_from_grasp.translation().x() + gripper.tip_m * approach.x();
  if (tips - checked.leaf_x < LimitOf("HND006"))
    findings.push_back(Found("HND006", checked.where, Number(tips - checked.leaf_x) + " m"));
  const GraspFit fit = WithTipClearance(measure(), tips);
  // what lies beyond the fingers, such as the far side of a wheel, is not between them
  const double width = fit.width_m > 0 ? fit.width_m : material->last - material->first;
  if (width > LimitOf("HND007"))
    findings.push_back(Found("HND007", checked.where, Number(width) + " m"));
  if (!fit.holds && findings.empty())
    findings.push_back(Found("HND008", checked.where,
                             std::string(fit.fingers_free ? "way free" : "way not free") +
                                 ", contact on " + Number(100 * fit.contact) + " % of the pads"));
  return findings;
}

}  // namespace

Findings CheckHandle(const DoorAsset& door, const LeafLines& leaf, const GraspMeasure& fit) {
  const MountedHandle mounted = Mounted(door, leaf);
  if (leaf.bounds.isEmpty() || mounted.grip.triangles.empty()) return {};
  Findings findings;
  const double surface = SurfaceAt(mounted.leaf, mounted.mount).value_or(leaf.bounds.max().x());
  const double buried = BuriedShare(mounted);
  if (buried > LimitOf("HND001"))
    findings.push_back(Found("HND001", "handle", Number(100 * buried) + " % of the surface"));
  const double protrusion = BoundsOf(mounted.grip).max().x() - surface;
  if (protrusion < LimitOf("HND002") && buried <= LimitOf("HND001"))
    findings.push_back(Found("HND002", "handle", Number(protrusion) + " m"));
  const double beyond = BeyondOutline(mounted);
  if (beyond > LimitOf("HND003"))
    findings.push_back(Found("HND003", "handle", Number(beyond) + " m"));
  const Findings stance = CheckStance(
      {leaf, mounted.grip, mounted.handle, surface, door.mechanism, beyond <= LimitOf("HND003")});
  findings.insert(findings.end(), stance.begin(), stance.end());
  // nobody grasps what does not stand out
  if (buried > LimitOf("HND001") || protrusion < LimitOf("HND002")) return findings;
  const RigidTransform frame_from_leaf = Translation({-surface, 0, 0});
  const auto behind = SurfaceAt(mounted.leaf, mounted.leaf_from_grasp.translation());
  const TriangleMesh grip_in_grasp = Transformed(mounted.grip, mounted.leaf_from_grasp.inverse());
  const CheckedGrasp grasp{"door.json: handle_from_grasp", grip_in_grasp,
                           frame_from_leaf * mounted.leaf_from_grasp,
                           behind ? *behind - surface : -std::numeric_limits<double>::infinity()};
  const Findings more = CheckGrasp(grasp, fit);
  findings.insert(findings.end(), more.begin(), more.end());
  return findings;
}

Findings CheckPartGrasp(const Part& part) {
  const PartPiece* grip = FindPiece(part, "grip");
  if (grip == nullptr || grip->mesh.triangles.empty()) return {};
  std::vector<TriangleMesh> meshes;
  for (const PartPiece& piece : part.pieces) meshes.push_back(piece.mesh);
  const TriangleMesh handle = Merged(meshes);
  const TriangleMesh grip_in_grasp = Transformed(grip->mesh, part.part_from_grasp.inverse());
  return CheckGrasp({"part.json: part_from_grasp", grip_in_grasp, part.part_from_grasp, 0},
                    [&] { return MeasureGrasp(grip->mesh, handle, part.part_from_grasp); });
}

}  // namespace doorforge::internal

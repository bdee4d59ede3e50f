// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/handle_place.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/mesh_transform.h"
#include "doorforge/parts/mechanism.h"

namespace doorforge::internal {
namespace {

constexpr double kAlongLeaf = 0.5;    // |axis.x| below this: the axis lies in the leaf
constexpr double kOneSided = 0.25;    // of the reach: a lever's middle is further from its axis
constexpr double kPadDepth = 0.012;   // [m] how deep the pads sit on what they grasp
constexpr double kTallLeaf = 1.5;     // [m]
constexpr double kMountHeight = 0.8;  // [m] above the bottom of a tall leaf
constexpr double kBackset = 0.08;     // [m]

Eigen::Vector3d FromAxis(const PartJoint& joint, const Eigen::Vector3d& point) {
  const Eigen::Vector3d arm = point - joint.origin_m;
  return arm - joint.axis * joint.axis.dot(arm);
}

double Reach(const TriangleMesh& handle, const PartJoint& joint) {
  double reach = 0;
  for (const Eigen::Vector3d& vertex : handle.vertices)
    reach = std::max(reach, FromAxis(joint, vertex).norm());
  return reach;
}

Mechanism MechanismOf(const TriangleMesh& handle, const HandleKnowledge& known) {
  if (known.mechanism) return *known.mechanism;
  if (!known.joint) return Mechanism::kNone;
  if (std::abs(known.joint->axis.x()) < kAlongLeaf) return Mechanism::kFlap;
  if (known.category == Category::kSafe) return Mechanism::kValve;
  const double off = FromAxis(*known.joint, BoundsOf(handle).center()).norm();
  return off > kOneSided * Reach(handle, *known.joint) ? Mechanism::kLever : Mechanism::kRound;
}

// on the leaf's plane at the axis, or in the middle
Eigen::Vector3d MountOf(const TriangleMesh& handle, const HandleKnowledge& known) {
  const Eigen::AlignedBox3d bounds = BoundsOf(handle);
  const std::optional<PartJoint>& joint = known.joint;
  Eigen::Vector3d mount = bounds.center();
  mount.x() = known.leaf_plane_m.value_or(bounds.min().x());
  if (!joint || std::abs(joint->axis.x()) < kAlongLeaf) return mount;
  const double along = (mount.x() - joint->origin_m.x()) / joint->axis.x();
  return joint->origin_m + along * joint->axis;
}

// middle of what lies in the outer half of the reach: where a lever is pressed
Eigen::Vector3d OuterMiddle(const TriangleMesh& handle, const PartJoint& joint) {
  const double reach = Reach(handle, joint);
  Eigen::AlignedBox3d outer;
  for (const Eigen::Vector3d& vertex : handle.vertices) {
    if (FromAxis(joint, vertex).norm() >= reach / 2) outer.extend(vertex);
  }
  return outer.center();
}

// approach along -x; the fingers close along z, or along y on what stands upright
RigidTransform GraspAt(const Eigen::Vector3d& point, bool upright) {
  RigidTransform grasp = Translation(point);
  if (upright)
    grasp.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  else
    grasp.linear() << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  return grasp;
}

RigidTransform ProposedGrasp(const TriangleMesh& handle, const HandlePlace& place,
                             const std::optional<Eigen::Vector3d>& stated) {
  const Eigen::AlignedBox3d bounds = BoundsOf(handle);
  Eigen::Vector3d at = bounds.center();
  Eigen::Vector3d size = bounds.sizes();
  if (place.mechanism == Mechanism::kRound || place.mechanism == Mechanism::kValve)
    at = place.joint.origin_m;
  if (place.mechanism == Mechanism::kLever) {
    at = OuterMiddle(handle, place.joint);
    size = (at - place.joint.origin_m).cwiseAbs();
  }
  at.x() = bounds.max().x() - std::min(kPadDepth, bounds.sizes().x() / 2);
  return GraspAt(stated.value_or(at), size.z() > size.y());
}

// positive angles press a lever down and pull a flap out
void OrientJoint(HandlePlace& place) {
  const Eigen::Vector3d grasp = place.part_from_grasp.translation();
  const Eigen::Vector3d velocity = place.joint.axis.cross(grasp - place.joint.origin_m);
  bool reverse = place.joint.axis.x() < 0;
  if (place.mechanism == Mechanism::kLever && std::abs(velocity.z()) > std::abs(velocity.y()))
    reverse = velocity.z() > 0;
  if (place.mechanism == Mechanism::kFlap) reverse = velocity.x() < 0;
  if (reverse) place.joint.axis = -place.joint.axis;
}

}  // namespace

HandlePlace PlaceHandle(const TriangleMesh& handle, const HandleKnowledge& known) {
  HandlePlace place;
  place.mechanism = MechanismOf(handle, known);
  place.mount_m = MountOf(handle, known);
  place.joint.axis = Eigen::Vector3d::UnitX();
  const TriangleMesh in_part = Transformed(handle, Translation(-place.mount_m));
  if (known.joint && place.mechanism != Mechanism::kNone) {
    place.joint = *known.joint;
    place.joint.origin_m -= place.mount_m;
    place.joint.lower_rad = 0;
    place.joint.upper_rad = HandleRange(known.category);
  }
  std::optional<Eigen::Vector3d> grasp = known.grasp_m;
  if (grasp) *grasp -= place.mount_m;
  place.part_from_grasp = ProposedGrasp(in_part, place, grasp);
  if (place.joint.upper_rad > 0) OrientJoint(place);
  return place;
}

Eigen::Vector3d DefaultMount(const TriangleMesh& leaf, Category category) {
  const Eigen::AlignedBox3d bounds = BoundsOf(leaf);
  const Eigen::Vector3d size = bounds.sizes();
  const bool tall = category == Category::kInterior && size.z() > kTallLeaf;
  return {bounds.max().x(), bounds.max().y() - std::min(kBackset, 0.15 * size.y()),
          tall ? bounds.min().z() + kMountHeight : bounds.center().z()};
}

}  // namespace doorforge::internal

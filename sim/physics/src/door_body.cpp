// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "door_body.h"

#include <algorithm>
#include <mutex>

#include <LinearMath/btQuickprof.h>

namespace doorforge::internal {
namespace {

constexpr double kLeastLeafInertia = 1e-2;
constexpr double kLeastHandleInertia = 5e-4;

BulletLink DoorBulletLink(const DoorJoint& joint, const DoorLink& link) {
  BulletLink result;
  const bool turns = joint.upper_rad > joint.lower_rad;
  result.joint = turns ? BulletJoint::kRevolute : BulletJoint::kFixed;
  result.parent_from_joint = joint.parent_from_child_at_zero;
  result.axis = joint.axis;
  result.lower = joint.lower_rad;
  result.upper = joint.upper_rad;
  result.mass = link.mass;
  result.hulls = HullsOf(link);
  return result;
}

double InertiaAbout(const DoorJoint& joint, const MassProperties& mass, double least) {
  const Eigen::Vector3d arm =
      mass.center_of_mass_m - joint.axis * joint.axis.dot(mass.center_of_mass_m);
  return std::max(joint.axis.dot(mass.inertia_kg_m2 * joint.axis), least) +
         mass.mass_kg * arm.squaredNorm();
}

}  // namespace

void SwitchProfilingOff() {
  static std::once_flag once;
  std::call_once(once, [] {
    btSetCustomEnterProfileZoneFunc([](const char*) {});
    btSetCustomLeaveProfileZoneFunc([] {});
  });
}

std::vector<TriangleMesh> HullsOf(const DoorLink& link) {
  std::vector<TriangleMesh> hulls;
  for (const DoorGeometry& geometry : link.geometry)
    hulls.insert(hulls.end(), geometry.hulls.begin(), geometry.hulls.end());
  return hulls;
}

std::vector<BulletLink> DoorLinks(const DoorAsset& door, double handle_friction) {
  BulletLink leaf = DoorBulletLink(door.hinge, door.links[kLeafLink]);
  leaf.least_inertia_kg_m2 = kLeastLeafInertia;
  BulletLink handle = DoorBulletLink(door.handle_joint, door.links[kHandleLink]);
  handle.parent = kHinge;
  handle.least_inertia_kg_m2 = kLeastHandleInertia;
  handle.friction = handle_friction;
  return {leaf, handle};
}

DoorInertia InertiaOf(const DoorAsset& door) {
  return {InertiaAbout(door.hinge, door.links[kLeafLink].mass, kLeastLeafInertia),
          InertiaAbout(door.handle_joint, door.links[kHandleLink].mass, kLeastHandleInertia)};
}

double DampingTorque(double damping, double velocity, double inertia, double time_step) {
  return -std::min(damping, 0.5 * inertia / time_step) * velocity;
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/watched_joints.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

// Speeds that drives, springs and the pull of the arm never come near.
constexpr double kFastestOverDrive = 12;  // where the drive's own limit is 1
constexpr double kFastestWithoutLimit = 30;
constexpr double kFastestSlide = 8;  // at least: a finger that slips off a bar under load is quick
constexpr double kFastestHinge = 20;
constexpr double kFastestHandle = 80;
// What drive and coupling of a finger can do together, see robot_body.cpp.
constexpr double kFingerLimit = 400;
// Torques over the joints' own limits, which an asset may leave at 0 [N m].
constexpr double kMostOverEffort = 10;
constexpr double kLeastHingeEffort = 200;
constexpr double kLeastHandleEffort = 20;

double FastestOf(const RobotJoint& joint) {
  const double fastest =
      joint.velocity > 0 ? kFastestOverDrive * joint.velocity : kFastestWithoutLimit;
  return joint.prismatic ? std::max(fastest, kFastestSlide) : fastest;
}

}  // namespace

std::vector<WatchedJoint> WatchedJointsOf(const RobotModel& model, const DoorAsset& door) {
  std::vector<WatchedJoint> joints;
  for (const RobotJoint& joint : model.joints())
    joints.push_back({joint.name, joint.prismatic, joint.lower, joint.upper, FastestOf(joint)});
  joints.push_back({"hinge", false, door.hinge.lower_rad, door.hinge.upper_rad, kFastestHinge});
  joints.push_back(
      {"handle", false, door.handle_joint.lower_rad, door.handle_joint.upper_rad, kFastestHandle});
  return joints;
}

std::vector<double> DriveLimitsOf(const RobotModel& model) {
  std::vector<double> limits;
  for (const RobotJoint& joint : model.joints()) limits.push_back(joint.effort);
  for (std::size_t i = limits.size() - 2; i < limits.size(); ++i) limits[i] = kFingerLimit;
  return limits;
}

// Latch, springs and whoever pulls stay far below these limits of hinge and handle.
std::array<double, 2> DoorTorqueLimits(const DoorAsset& door) {
  return {kMostOverEffort * std::max(door.hinge.effort_limit_nm, kLeastHingeEffort),
          kMostOverEffort * std::max(door.handle_joint.effort_limit_nm, kLeastHandleEffort)};
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Where a pad meets the handle when only this finger closes.
struct PadContact {
  double finger_position_m = 0;  ///< Half opening at which they touch, in [0, 0.04].
  Eigen::Vector3d point_in_tcp_m = Eigen::Vector3d::Zero();
  /// Surface normal of the handle there, out of it, in the tool centre's frame.
  Eigen::Vector3d normal_in_tcp = Eigen::Vector3d::Zero();
};

/// Static geometry of a grasp: hand and fingers against the hulls of a closed door.
class GraspProbe {
 public:
  GraspProbe(const DoorAsset& door, const RobotModel& robot);
  ~GraspProbe();
  GraspProbe(GraspProbe&&) noexcept;
  GraspProbe& operator=(GraspProbe&&) noexcept;

  /// Smallest distance between the gripper (hand and both fingers, each `finger_position_m` from
  /// the middle) and any part of the door with the tool centre there; negative: depth of the
  /// overlap. Exact up to `cutoff_m`, which is returned for everything farther.
  double Clearance(const RigidTransform& door_from_tcp, double finger_position_m,
                   double cutoff_m) const;

  /// Closes one finger (kLeftFinger or kRightFinger) until it touches the handle; nothing if it
  /// passes by.
  std::optional<PadContact> Close(const RigidTransform& door_from_tcp, int finger) const;

 private:
  class Runtime;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Pieces that are inside each other, by their names.
struct StartOverlap {
  std::string robot;
  std::string door;
};

/// Static geometry of a start, or of another moment: all of a robot, its base among it, against the
/// hulls of a door at these angles, closed unless said otherwise: frame or shell, leaf and handle.
class SpawnCollisionChecker {
 public:
  SpawnCollisionChecker(const DoorAsset& door, const RobotModel& robot, double hinge_rad = 0,
                        double handle_rad = 0);
  ~SpawnCollisionChecker();
  SpawnCollisionChecker(SpawnCollisionChecker&&) noexcept;
  SpawnCollisionChecker& operator=(SpawnCollisionChecker&&) noexcept;

  /// The first pieces that overlap with the robot there, with a millimetre around each; nothing
  /// where the robot is free. Deterministic.
  ///
  /// @param pose Of the robot that the probe was made for.
  std::optional<StartOverlap> Find(const RobotPose& pose,
                                   const RigidTransform& world_from_door) const;

  /// By how much pieces of the robot come nearer than `gap_m` to frame or leaf, each by its nearest
  /// place and by 2 cm at most, summed over the pieces [m]; 0 where all keep away. Around each
  /// there is a millimetre, as in Find(). The handle, which may be held, does not count.
  /// Deterministic.
  double Crowding(const RobotPose& pose, const RigidTransform& world_from_door, double gap_m) const;

 private:
  class Runtime;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace doorforge

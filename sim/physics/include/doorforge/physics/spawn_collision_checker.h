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

/// Static geometry of a start: all of a robot, its base among it, against the hulls of a closed
/// door: frame or shell, leaf and handle.
class SpawnCollisionChecker {
 public:
  SpawnCollisionChecker(const DoorAsset& door, const RobotModel& robot);
  ~SpawnCollisionChecker();
  SpawnCollisionChecker(SpawnCollisionChecker&&) noexcept;
  SpawnCollisionChecker& operator=(SpawnCollisionChecker&&) noexcept;

  /// The first pieces that overlap with the robot there, with a millimetre around each; nothing
  /// where the robot is free. Deterministic.
  ///
  /// @param pose Of the robot that the probe was made for.
  std::optional<StartOverlap> Find(const RobotPose& pose,
                                   const RigidTransform& world_from_door) const;

 private:
  class Runtime;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace doorforge

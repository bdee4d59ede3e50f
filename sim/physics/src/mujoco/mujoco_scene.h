// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/bolt.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge::internal {

/// What a geom of MuJoCo is a piece of.
struct MujocoPiece {
  enum class Side { kRobot, kDoor, kLatch };
  Side side = Side::kRobot;
  int link = 0;         ///< Joint of the robot, or DoorLinkIndex.
  double friction = 0;  ///< It is multiplied with that of what it touches.
};

/// A scene as MuJoCo takes it.
struct MujocoSceneText {
  std::string xml;
  std::vector<MujocoPiece> pieces;  ///< Piece i is the geom "g<i>".
};

/// Bullet keeps 1 mm around each hull, so shapes meet at this distance of their hulls [m].
inline constexpr double kMujocoSkin = 0.002;

/// The scene as MJCF: bodies, masses with their least inertias, hulls, joints with stops, damping
/// of the door, and a bolt with its strike and cable as the export has them. Joints are "robot<i>",
/// "leaf", "handle" and "bolt"; one that does not turn is left out. No actuators: drives, springs
/// and latch act by way of the engine.
///
/// @param door With the scene's variation and latch.
MujocoSceneText DescribeForMujoco(const Scene& scene, const DoorAsset& door,
                                  const RobotModel& robot, const std::optional<Bolt>& bolt,
                                  double time_step_s);

}  // namespace doorforge::internal

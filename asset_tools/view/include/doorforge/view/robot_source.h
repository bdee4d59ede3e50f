// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/physics/load_robot.h"

namespace doorforge {

/// The robot that episodes are shown with.
struct ShownRobot {
  std::filesystem::path urdf = {};  ///< Empty: the built-in one.
  RobotMeshReader read_mesh = {};   ///< Reads that robot's meshes, see LoadRobot().
};

}  // namespace doorforge

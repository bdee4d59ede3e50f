// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/load_robot.h"

namespace doorforge {

/// Reads the meshes of a user's robot in any format of ImportMesh(), in a process of its own; in a
/// build without the mesh room canonical OBJ files only.
RobotMeshReader RobotMeshes();

}  // namespace doorforge

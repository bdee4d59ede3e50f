// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "doorforge/physics/load_robot.h"

#include "robot/robot_tree.h"

namespace doorforge::internal {

/// Reads shapes of a URDF as meshes; what cannot be read is a fault.
class RobotShapes {
 public:
  RobotShapes(std::filesystem::path folder, const RobotOptions& options,
              const RobotMeshReader& read_mesh, RobotFaults& faults)
      : folder_(std::move(folder)), options_(options), read_mesh_(read_mesh), faults_(faults) {}

  /// In the frame's body.
  RobotPiece Visual(const std::string& link, const UrdfShape& shape, const RobotFrame& frame);
  /// Returns its convex hull.
  RobotPiece Hull(const std::string& link, const UrdfShape& shape, const RobotFrame& frame);

 private:
  TriangleMesh MeshOf(const std::string& where, const UrdfGeometry& geometry);
  TriangleMesh Read(const std::string& where, const UrdfMeshFile& file);
  std::filesystem::path PathOf(const std::string& filename) const;

  std::filesystem::path folder_;
  const RobotOptions& options_;
  const RobotMeshReader& read_mesh_;
  RobotFaults& faults_;
  std::map<std::filesystem::path, TriangleMesh> read_;  // fingers share their file
};

}  // namespace doorforge::internal

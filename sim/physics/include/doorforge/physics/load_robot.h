// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// Which of a robot's shapes a camera sees.
enum class RobotVisuals { kMesh, kCollision };
inline constexpr NamedValue<RobotVisuals> kRobotVisuals[] = {
    {RobotVisuals::kMesh, "mesh"}, {RobotVisuals::kCollision, "collision"}};
constexpr std::span<const NamedValue<RobotVisuals>> ValuesOf(RobotVisuals) { return kRobotVisuals; }

/// What a URDF does not say, or what is guessed wrongly. Read from NAME.robot.yaml beside NAME.urdf
/// where there is one.
struct RobotOptions {
  std::string hand_link;            ///< Empty: the link that carries the fingers.
  std::vector<std::string> fingers; /**< Joints of left and right finger. Empty: the two sliding
                                         joints of one body. Left is where the tool's y points. */
  std::string tcp_link;             ///< A link whose frame is the tool centre.
  std::vector<double> tcp_xyz_m;    ///< Else its place in the hand link. Both empty: guessed.
  std::vector<double> tcp_rpy_rad;
  std::vector<double> rest_rad;  ///< Posture of the arm joints at the start. Empty: 0.3 (low + up).
  double density_kg_m3 = 0;      ///< Links without inertia get it; 0: they are a fault.
  RobotVisuals visuals = RobotVisuals::kMesh;
  std::vector<std::string> package_folders;  ///< Where package:// is looked for besides.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("hand_link", self.hand_link);
    visit("fingers", self.fingers);
    visit("tcp_link", self.tcp_link);
    visit("tcp_xyz_m", self.tcp_xyz_m);
    visit("tcp_rpy_rad", self.tcp_rpy_rad);
    visit("rest_rad", self.rest_rad);
    visit("density_kg_m3", self.density_kg_m3);
    visit("visuals", self.visuals);
    visit("package_folders", self.package_folders);
  }
};

/// Reads a mesh file of any format, in metres and in the file's own frame. Throws Error where it
/// cannot. Programs give ImportMesh() of the mesh room, which this room may not use.
using RobotMeshReader = std::function<TriangleMesh(const std::filesystem::path&)>;

/// Where a robot comes from.
struct RobotSource {
  std::filesystem::path urdf;  ///< Empty: the built-in mobile Franka.
  RobotOptions options;
  RobotMeshReader read_mesh;  ///< Empty: canonical meshes only, see mesh_file.h.
};

/// Makes a robot of a URDF; `source.urdf` only says where its meshes are looked for.
///
/// Roles are read from the tree: the fingers are the two sliding joints on one body, the arm is the
/// chain from there to the root, 6 to 8 turning joints; two sliding joints before them are a base
/// of the robot's own, else it is set on the sliders of the built-in robot. The root faces x, z is
/// up. Collision shapes are taken as their convex hulls. With RobotBase::kFloating the link that
/// carries the fingers, and what is fixed below it, is all that is taken: there need be no arm.
///
/// @throws Error(kFormat) naming every fault: joints without limits or effort, links without mass,
///     shapes without a file, moving joints without a role, names in the options that the URDF does
///     not have.
RobotModel BuildRobot(const UrdfModel& urdf, const RobotSource& source, RobotBase base);

/// The robot of a URDF file and of the options beside it; the built-in mobile Franka if `urdf` is
/// empty. Throws as BuildRobot() and ReadUrdf() do, and Error(kInvalidConfig) on options that are
/// not as above.
RobotModel LoadRobot(const std::filesystem::path& urdf, RobotBase base,
                     const RobotMeshReader& read_mesh = {});

}  // namespace doorforge

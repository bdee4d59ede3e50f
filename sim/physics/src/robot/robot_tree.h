// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "doorforge/physics/load_robot.h"

namespace doorforge::internal {

/// Everything that is wrong with a robot, told at once.
class RobotFaults {
 public:
  explicit RobotFaults(std::string robot) : robot_(std::move(robot)) {}

  void Add(std::string problem) { problems_.push_back(std::move(problem)); }
  /// Adds a fault that names the nearest of the known names where `name` is not among them.
  bool Knows(const std::string& name, const std::vector<std::string>& known,
             const std::string& where);
  /// Throws Error(kFormat) with all faults, if there are any.
  void Check() const;

 private:
  std::string robot_;
  std::vector<std::string> problems_;
};

/// Which joints of a URDF do what.
struct RobotRoles {
  std::vector<std::string> base;  ///< Two sliders of the robot's own, or none.
  std::vector<std::string> arm;   ///< From the root to the hand.
  std::vector<std::string> fingers;
  std::string hand_link;
};

/// Reads the roles from the tree. Where that fails, the faults say why and the roles are not whole.
/// Where the hand is to fly, only hand and fingers are looked for.
RobotRoles FindRoles(const UrdfModel& urdf, const RobotOptions& options, RobotBase base,
                     RobotFaults& faults);

/// The URDF on the base that is asked for; `roles` gets its joints.
UrdfModel OnBase(UrdfModel urdf, RobotBase base, RobotRoles& roles);

/// Frames of all links when the joints of `order` move and all others are fixed.
std::map<std::string, RobotFrame> FramesOf(const UrdfModel& urdf,
                                           const std::vector<std::string>& order);

}  // namespace doorforge::internal

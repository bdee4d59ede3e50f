// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/physics/robot_model.h"

namespace doorforge {

/// Square, one row a joint, fingers included.
using JointMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostRobotJoints, kMostRobotJoints>;

/// The robot's inertia in the space of its joints at a pose of PoseAt(): composite rigid bodies
/// (Featherstone, Rigid Body Dynamics Algorithms, 2008, 6.2), in world coordinates. Symmetric,
/// positive definite [kg, kg m, kg m^2].
///
/// @param masses Of the joints' bodies, each in its frame; as long as the robot has joints.
JointMatrix MassMatrix(const RobotModel& robot, const RobotPose& pose,
                       std::span<const MassProperties> masses);
/// With the robot's own masses.
JointMatrix MassMatrix(const RobotModel& robot, const RobotPose& pose);

}  // namespace doorforge

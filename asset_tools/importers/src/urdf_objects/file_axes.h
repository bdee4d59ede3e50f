// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>

namespace doorforge::internal {

/// The unit vector of "x", "y", "z", "-x", "-y" or "-z". Throws Error(kInvalidArgument), naming
/// `flag`, on anything else.
Eigen::Vector3d AxisNamed(const std::string& name, const std::string& flag);

/// The turn that brings a file's axis `up` to z; the file's axis after it comes to x.
Eigen::Matrix3d UprightFrom(const std::string& up);

/// The turn that brings `up` to z and `front` to x. Throws Error(kInvalidArgument) if both lie on
/// one axis.
Eigen::Matrix3d PartAxesFrom(const std::string& up, const std::string& front);

}  // namespace doorforge::internal

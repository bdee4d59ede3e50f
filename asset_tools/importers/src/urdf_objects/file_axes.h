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

/// The unit vector of an axis (see AxisNamed()), or of a direction "x,y,z", three numbers of any
/// length above 0. Throws Error(kInvalidArgument), naming `flag`, on anything else.
Eigen::Vector3d DirectionNamed(const std::string& name, const std::string& flag);

/// The turn that brings `front` to x, and `up`, as far as it is square to it, to z; both as
/// DirectionNamed() reads them. Throws Error(kInvalidArgument) if they are less than five degrees
/// from one line.
Eigen::Matrix3d PartAxesFrom(const std::string& up, const std::string& front);

}  // namespace doorforge::internal

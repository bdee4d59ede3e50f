// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rng.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// Hand rotations that a grasp is chosen from.
struct OrientationSampling {
  int count = 50;
  double tilt_rad = 0.1;  ///< Standard deviation of the approach about both its normals.
};

/// Samples world_from_hand rotations (UniDoorManip, Section 4): the hand's z, its approach, is
/// `approach` but for the tilt, and the hand is turned about it by any angle. On all handles but
/// flaps the approach is the handle's axis, so that the fingers close (along the hand's y) in the
/// plane normal to it. A right-handed orthonormal matrix each; a function of the arguments and the
/// stream.
///
/// @param approach World, any length but 0.
/// @throws Error(kInvalidArgument) if `approach` is zero or not finite.
std::vector<Eigen::Matrix3d> SampleOrientations(const Eigen::Vector3d& approach,
                                                const OrientationSampling& sampling, Rng& rng);

/// The fingers are alike: the same grasp with the hand turned by half a turn about its approach.
ActionVector HalfTurned(const ActionVector& grasp);

}  // namespace doorforge

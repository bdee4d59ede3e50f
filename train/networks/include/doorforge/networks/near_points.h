// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

// What lies around the fingers, as the discriminator is told of it.

namespace doorforge::internal {

/// The `count` points nearest to point 0 and within kNearRadius of it, from point 0 on: 3 x count
/// [m], along the world's axes, the nearest first. Where there are fewer, point 0 stands in: copies
/// do not change a maximum.
Eigen::Matrix3Xf NearestToFirst(std::span<const float> xyz, int count);

/// The points in an order in which those near each other lie together, without what stands in for
/// missing ones: a maximum over them is the same, and sooner found (Kernels::multiply_sparse).
Eigen::Matrix3Xf InPatches(const Eigen::Matrix3Xf& near);

/// Appends the points as the hand sees them, in units of 5 cm: x, y, z of each, y along the way
/// the fingers close, z into the leaf.
void AppendInHandFrame(const Eigen::Matrix3Xf& near, const Eigen::Matrix3d& world_from_hand,
                       std::vector<float>& out);

}  // namespace doorforge::internal

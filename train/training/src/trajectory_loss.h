// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/policy/trajectory_networks.h"

// The loss of the proposer of trajectories in libtorch; policies run it without.

namespace doorforge::internal {

/// What it learns of n trajectories that did what was asked for.
struct ProposerBatch {
  int size = 0;                        ///< n.
  std::vector<float> points = {};      ///< n x P x kDoorPoint.
  std::vector<float> targets = {};     ///< n x kTargetNumbers.
  std::vector<float> trajectory = {};  ///< n x TrajectoryNumbers().
  std::vector<float> noise = {};       ///< n x latent, N(0, 1).
};

struct ProposerWeights {
  double waypoints = 10;
  double rotation = 5;
  double latent = 0.2;
};

/// Sum over the trajectories of
///   waypoints * mean |waypoint numbers - theirs| + rotation * angle between the grasps' rotations
///   + latent * KL(posterior || N(0, 1)), summed over the latent numbers.
/// Adds `weight` times its gradient to `gradient`, as long as `parameters`: those of the proposer
/// and then of the posterior. An empty one: no gradient.
double ProposerLossOf(const TrajectoryShape& shape, std::span<const float> parameters,
                      const ProposerBatch& batch, const ProposerWeights& weights, double weight,
                      std::span<float> gradient);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "doorforge/learn/point_encoder.h"
#include "doorforge/learn/stage_networks.h"

namespace doorforge::internal {

/// Rates orientations at one contact point by the discriminator. Serves several threads.
class GraspRater {
 public:
  /// `networks` of the family kGrasp, which outlive the rater.
  explicit GraspRater(const StageNetworks& networks);

  /// Final door angles [rad] that are expected, one an orientation: the mean of both ways to hold
  /// the hand. `xyz`: 4096 points, point 0 is the contact.
  std::vector<float> Rate(std::span<const float> xyz,
                          std::span<const Eigen::Matrix3d> orientations) const;

 private:
  const StageNetworks* networks_;
  PointEncoder encoder_;
};

/// Each rating as the mean of all, weighted by how near their orientations are, see
/// GraspOptions::smoothing_rad.
std::vector<float> Smoothed(std::span<const float> ratings,
                            std::span<const Eigen::Matrix3d> orientations, double width_rad);

/// Mean of the highest `best` of the ratings, which are at least one.
float MeanOfBest(std::vector<float> ratings, std::size_t best);

}  // namespace doorforge::internal

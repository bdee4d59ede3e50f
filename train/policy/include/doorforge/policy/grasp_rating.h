// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "doorforge/networks/heads.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/networks/stage_networks.h"

namespace doorforge::internal {

/// Rates orientations at one contact point by the discriminator. Serves several threads.
class GraspRater {
 public:
  /// `networks` of the family kGrasp, which outlive the rater.
  explicit GraspRater(const StageNetworks& networks);

  /// Final door angles [rad] that are expected, one an orientation: the mean of both ways to hold
  /// the hand. `cloud`: 4096 points, point 0 is the contact.
  std::vector<float> Rate(const CloudView& cloud,
                          std::span<const Eigen::Matrix3d> orientations) const;

 private:
  const StageNetworks* networks_;
  PointEncoder encoder_;
  DiscriminatorHead head_;
};

/// A hand at a contact point, and the door angle that the discriminator expects of it.
struct RatedHand {
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
  double rating_rad = 0;
};

/// The ratings, each as the mean of all, weighted by exp(-(angle / width_rad)^2 - (distance of the
/// contacts / width_m)^2), alike fingers alike. A width of 0: of those alone that do not differ.
std::vector<double> Smoothed(std::span<const RatedHand> hands, double width_rad, double width_m);

/// Mean of the highest `best` of the ratings, which are at least one.
float MeanOfBest(std::vector<float> ratings, std::size_t best);

}  // namespace doorforge::internal

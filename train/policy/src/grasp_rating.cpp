// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/grasp_rating.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/handle_points.h"
#include "doorforge/networks/near_points.h"
#include "doorforge/policy/orientation_sampling.h"

namespace doorforge::internal {
namespace {

double Falloff(double difference, double width) {
  if (width <= 0) return difference > 0 ? 0 : 1;
  return std::exp(-(difference / width) * (difference / width));
}

// [rad], whichever finger comes first.
double AngleBetween(const RatedHand& a, const RatedHand& b) {
  const Eigen::Matrix3d turn = a.world_from_hand_rotation.transpose() * b.world_from_hand_rotation;
  const Eigen::Matrix3d half_turn = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  const double cosine = (std::max(turn.trace(), (turn * half_turn).trace()) - 1) / 2;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

GraspRater::GraspRater(const StageNetworks& networks)
    : networks_(&networks),
      encoder_(CriticLayout(NetworkFamily::kGrasp), "encoder.", networks.critic,
               BestInstructionSet()),
      head_(networks) {}

std::vector<float> GraspRater::Rate(std::span<const float> xyz,
                                    std::span<const Eigen::Matrix3d> orientations) const {
  const StageNormalisation& normalisation = networks_->normalisation;
  const bool by_near_points = normalisation.view.near_points > 0;
  std::vector<float> feature;
  if (!by_near_points)
    feature = encoder_.Forward(BuildGeometry(xyz, GraspWindow(normalisation, xyz))).features;
  const std::array<float, 3> origin = GraspOrigin(normalisation, xyz);
  const Eigen::Vector3d contact(xyz[0] - origin[0], xyz[1] - origin[1], xyz[2] - origin[2]);
  const Eigen::Matrix3Xf near = NearestToFirst(xyz, normalisation.view.near_points);
  HeadInputs batch;
  batch.size = static_cast<int>(2 * orientations.size());
  for (const Eigen::Matrix3d& orientation : orientations) {
    const ActionVector grasp = ToVector({contact, orientation});
    for (const ActionVector& way : {grasp, HalfTurned(grasp)}) {
      const ActionVector numbers = normalisation.action.Apply(way);
      batch.actions.insert(batch.actions.end(), numbers.begin(), numbers.end());
      batch.features.insert(batch.features.end(), feature.begin(), feature.end());
      AppendInHandFrame(near, FromVector(way).world_from_hand_rotation, batch.near);
    }
  }
  const std::vector<float> scores = head_.Score(batch);
  std::vector<float> ratings;
  for (std::size_t i = 0; i < scores.size(); i += 2)
    ratings.push_back((scores[i] + scores[i + 1]) / 2);
  return ratings;
}

std::vector<double> Smoothed(std::span<const RatedHand> hands, double width_rad, double width_m) {
  std::vector<double> smoothed;
  for (const RatedHand& hand : hands) {
    double sum = 0;
    double weights = 0;
    for (const RatedHand& other : hands) {
      const double weight = &hand == &other
                                ? 1
                                : Falloff((hand.contact_m - other.contact_m).norm(), width_m) *
                                      Falloff(AngleBetween(hand, other), width_rad);
      sum += weight * other.rating_rad;
      weights += weight;
    }
    smoothed.push_back(sum / weights);
  }
  return smoothed;
}

float MeanOfBest(std::vector<float> ratings, std::size_t best) {
  best = std::min(best, ratings.size());
  std::sort(ratings.begin(), ratings.end(), std::greater<>());
  return std::accumulate(ratings.begin(), ratings.begin() + static_cast<std::ptrdiff_t>(best),
                         0.0F) /
         static_cast<float>(best);
}

}  // namespace doorforge::internal

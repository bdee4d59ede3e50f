// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/grasp_rating.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/handle_points.h"
#include "doorforge/networks/near_points.h"
#include "doorforge/policy/orientation_sampling.h"

namespace doorforge::internal {
namespace {

constexpr double kNegligible = 23;  // exp(-23) = 1e-10: eight hundred such hands count as nothing

// exp(-Exponent()) is what a difference leaves of a weight.
double Exponent(double difference, double width) {
  if (width <= 0) return difference > 0 ? kNegligible : 0;
  return (difference / width) * (difference / width);
}

// Gives the cosine of the angle, whichever finger comes first.
double CosineBetween(const RatedHand& a, const RatedHand& b) {
  const Eigen::Matrix3d& from = a.world_from_hand_rotation;
  const Eigen::Matrix3d& to = b.world_from_hand_rotation;
  const double approach = from.col(2).dot(to.col(2));
  const double across = from.col(0).dot(to.col(0)) + from.col(1).dot(to.col(1));
  return std::clamp((approach + std::abs(across) - 1) / 2, -1.0, 1.0);
}

/// How hands weigh in each other's means.
class Neighbourhood {
 public:
  Neighbourhood(double width_rad, double width_m)
      : width_rad_(width_rad),
        width_m_(width_m),
        least_cosine_(std::cos(std::min(std::sqrt(kNegligible) * width_rad, std::numbers::pi))) {}

  /// 0 where it is negligible.
  double Weight(const RatedHand& a, const RatedHand& b) const {
    const double apart = Exponent((a.contact_m - b.contact_m).norm(), width_m_);
    if (apart >= kNegligible) return 0;
    const double cosine = CosineBetween(a, b);
    if (cosine < least_cosine_) return 0;
    const double exponent = apart + Exponent(std::acos(cosine), width_rad_);
    return exponent >= kNegligible ? 0 : std::exp(-exponent);
  }

 private:
  double width_rad_;
  double width_m_;
  double least_cosine_;
};

}  // namespace

GraspRater::GraspRater(const StageNetworks& networks)
    : networks_(&networks),
      encoder_(networks.critic_layout(), "encoder.", networks.critic, BestInstructionSet()),
      head_(networks) {}

std::vector<float> GraspRater::Rate(const CloudView& cloud,
                                    std::span<const Eigen::Matrix3d> orientations) const {
  const std::span<const float> xyz = cloud.xyz;
  const StageNormalisation& normalisation = networks_->normalisation;
  const bool by_near_points = normalisation.view.near_points > 0;
  std::vector<float> feature;
  if (!by_near_points)
    feature = encoder_.Forward(BuildGeometry(cloud, GraspWindow(normalisation, xyz))).features;
  const std::array<float, 3> origin = GraspOrigin(normalisation, xyz);
  const Eigen::Vector3d contact(xyz[0] - origin[0], xyz[1] - origin[1], xyz[2] - origin[2]);
  const Eigen::Matrix3Xf near = InPatches(NearestToFirst(xyz, normalisation.view.near_points));
  HeadInputs batch;
  batch.size = static_cast<int>(2 * orientations.size());
  batch.near.reserve(2 * orientations.size() * static_cast<std::size_t>(near.size()));
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
  const Neighbourhood neighbourhood(width_rad, width_m);
  std::vector<double> smoothed;  // sums until the end
  for (const RatedHand& hand : hands) smoothed.push_back(hand.rating_rad);
  std::vector<double> weights(hands.size(), 1);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    for (std::size_t k = i + 1; k < hands.size(); ++k) {
      const double weight = neighbourhood.Weight(hands[i], hands[k]);
      smoothed[i] += weight * hands[k].rating_rad;
      smoothed[k] += weight * hands[i].rating_rad;
      weights[i] += weight;
      weights[k] += weight;
    }
  }
  for (std::size_t i = 0; i < hands.size(); ++i) smoothed[i] /= weights[i];
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

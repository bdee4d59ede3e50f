// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "grasp_rating.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "doorforge/learn/cloud_geometry.h"
#include "doorforge/learn/orientation_sampling.h"

#include "handle_points.h"
#include "head_networks.h"

namespace doorforge::internal {

GraspRater::GraspRater(const StageNetworks& networks)
    : networks_(&networks),
      encoder_(CriticLayout(NetworkFamily::kGrasp), "encoder.", networks.critic,
               BestInstructionSet()) {}

std::vector<float> GraspRater::Rate(std::span<const float> xyz,
                                    std::span<const Eigen::Matrix3d> orientations) const {
  const StageNormalisation& normalisation = networks_->normalisation;
  const CloudGeometry geometry = BuildGeometry(xyz, GraspWindow(normalisation, xyz));
  const std::vector<float> feature = encoder_.Forward(geometry).features;
  const std::array<float, 3> origin = GraspOrigin(normalisation, xyz);
  const Eigen::Vector3d contact(xyz[0] - origin[0], xyz[1] - origin[1], xyz[2] - origin[2]);
  HeadBatch batch;
  batch.size = static_cast<int>(2 * orientations.size());
  for (const Eigen::Matrix3d& orientation : orientations) {
    const ActionVector grasp = ToVector({contact, orientation});
    for (const ActionVector& way : {grasp, HalfTurned(grasp)}) {
      const ActionVector numbers = normalisation.action.Apply(way);
      batch.actions.insert(batch.actions.end(), numbers.begin(), numbers.end());
      batch.features.insert(batch.features.end(), feature.begin(), feature.end());
    }
  }
  const std::vector<float> scores = ScoreGrasps(*networks_, batch);
  std::vector<float> ratings;
  for (std::size_t i = 0; i < scores.size(); i += 2)
    ratings.push_back((scores[i] + scores[i + 1]) / 2);
  return ratings;
}

float MeanOfBest(std::vector<float> ratings, std::size_t best) {
  best = std::min(best, ratings.size());
  std::sort(ratings.begin(), ratings.end(), std::greater<>());
  return std::accumulate(ratings.begin(), ratings.begin() + static_cast<std::ptrdiff_t>(best),
                         0.0F) /
         static_cast<float>(best);
}

}  // namespace doorforge::internal

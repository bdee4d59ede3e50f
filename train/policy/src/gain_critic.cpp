// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/gain_critic.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/hand_frame.h"

namespace doorforge {
namespace {

StageNetworks RequireMotion(StageNetworks networks) {
  Require(networks.family == NetworkFamily::kMotion, ErrorCode::kInvalidArgument,
          "the networks of a grasp have no critic of actions");
  return networks;
}

}  // namespace

GainCritic::GainCritic(StageNetworks networks)
    : networks_(RequireMotion(std::move(networks))),
      encoder_(networks_.critic_layout(), "encoder.", networks_.critic, BestInstructionSet()),
      head_(networks_) {}

double GainCritic::GainOf(const Observation& observation, const Action& action) const {
  const StageNormalisation& normalisation = networks_.normalisation;
  const Proprioception& proprioception = observation.proprioception;
  const Eigen::Vector3f hand_m = HandPositionOf(proprioception);
  const CloudWindow window = WindowOf(normalisation, {hand_m.x(), hand_m.y(), hand_m.z()});
  internal::HeadInputs batch;
  batch.size = 1;
  batch.features = encoder_.Forward(BuildGeometry(observation.cloud, window)).features;
  internal::AppendRobotState(normalisation, {proprioception}, batch);
  ActionVector numbers = ToVector(action);
  if (normalisation.view.frame == ViewFrame::kHand)
    numbers = internal::TurnOf(numbers, HandRotationOf(proprioception));
  numbers = normalisation.action.Apply(numbers);
  batch.actions.assign(numbers.begin(), numbers.end());
  return static_cast<double>(head_.Score(batch).front());
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/gain_critic.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/policy/stage_policy.h"

#include "door_cloud.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

Observation TurnedObservation() {
  const auto made = testing::MakeSyntheticSamples(2, 1);
  Observation observation;
  observation.cloud.xyz = made.clouds.front();
  observation.proprioception = made.samples.front().proprioception;
  const std::array<float, 4> turned = {0.5F, -0.5F, 0.5F, 0.5F};
  std::copy(turned.begin(), turned.end(), observation.proprioception.end() - 4);
  return observation;
}

// The policy takes the best of its candidates by its own critic, and the first draws of many are
// the draws of few: by the same critic more candidates are never worse, and many are better.
TEST(GainCritic, RatesActionsAsThePolicyThatChoosesAmongThem) {
  const auto made = testing::MakeSyntheticSamples(1, 5);
  const Observation observation = TurnedObservation();
  for (const ViewFrame frame : {ViewFrame::kWorld, ViewFrame::kHand}) {
    NetworkView view;
    view.frame = frame;
    StageNetworks networks = InitialNetworks(MeasureNormalisation(made.samples, view), false, 4);
    networks.normalisation.action.deviation.fill(0.3F);  // so that candidates differ
    const GainCritic critic(networks);
    double least = 0;
    double most = 0;
    for (const int candidates : {1, 2, 4, 8, 16, 32}) {
      const Action chosen = MakePolicy(networks, {.candidates = candidates})->Act(observation);
      const double gain = critic.GainOf(observation, chosen);
      if (candidates == 1) least = most = gain;
      // an action's rotation is made orthonormal, which rounds
      EXPECT_GE(gain, most - 5e-6) << candidates;
      most = gain;
    }
    EXPECT_GT(most, least + 1e-5);
  }
}

TEST(GainCritic, RefusesTheNetworksOfAGrasp) {
  const auto made = testing::MakeSyntheticSamples(1, 5);
  EXPECT_THROW(GainCritic(InitialNetworks(MeasureNormalisation(made.samples), false, 4,
                                          NetworkFamily::kGrasp)),
               Error);
}

}  // namespace
}  // namespace doorforge

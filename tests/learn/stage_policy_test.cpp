// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/learn/stage_policy.h"

#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/learn/checkpoint.h"

#include "door_cloud.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

StageNetworks SomeNetworks() {
  const auto made = testing::MakeSyntheticSamples(1, 3);
  return InitialNetworks(MeasureNormalisation(made.samples), false, 4);
}

Observation SomeObservation() {
  Observation observation;
  observation.cloud.xyz = testing::DoorCloud(8, 0.4);
  for (std::size_t i = 0; i < observation.proprioception.size(); ++i)
    observation.proprioception[i] = 0.05F * static_cast<float>(i);
  return observation;
}

TEST(StagePolicy, ActsAlikeInMemoryAndFromItsFolder) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "doorforge_stage_policy";
  std::filesystem::remove_all(folder);
  WritePolicy(folder, SomeNetworks(), {"open", "abc", "v", {}, 1});
  const Observation observation = SomeObservation();
  const Action memory = MakePolicy(SomeNetworks())->Act(observation);
  const Action loaded = LoadPolicy(folder)->Act(observation);
  EXPECT_EQ(memory.position_delta_m, loaded.position_delta_m);
  EXPECT_EQ(memory.world_from_hand_rotation, loaded.world_from_hand_rotation);
  EXPECT_NEAR((memory.world_from_hand_rotation * memory.world_from_hand_rotation.transpose() -
               Eigen::Matrix3d::Identity())
                  .norm(),
              0, 1e-6);
}

TEST(StagePolicy, RepeatsAnEpisodeAfterReset) {
  PolicyOptions options;
  options.candidates = 4;
  const auto policy = MakePolicy(SomeNetworks(), options);
  const Observation observation = SomeObservation();
  policy->Reset();
  const Action first = policy->Act(observation);
  const Action second = policy->Act(observation);
  policy->Reset();
  EXPECT_EQ(policy->Act(observation).position_delta_m, first.position_delta_m);
  EXPECT_EQ(policy->Act(observation).position_delta_m, second.position_delta_m);
}

TEST(StagePolicy, WithOneCandidateNeitherSeedNorRepetitionMatters) {
  PolicyOptions options;
  options.seed = 99;
  const Observation observation = SomeObservation();
  const auto policy = MakePolicy(SomeNetworks(), options);
  const Action first = policy->Act(observation);
  EXPECT_EQ(policy->Act(observation).position_delta_m, first.position_delta_m);
  EXPECT_EQ(MakePolicy(SomeNetworks())->Act(observation).position_delta_m, first.position_delta_m);
}

TEST(StagePolicy, RefusesObservationsItCannotRead) {
  const auto policy = MakePolicy(SomeNetworks());
  Observation observation = SomeObservation();
  observation.cloud.xyz.resize(300);
  EXPECT_THROW(policy->Act(observation), Error);
  observation = SomeObservation();
  observation.cloud.xyz[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(policy->Act(observation), Error);
  observation = SomeObservation();
  observation.proprioception[3] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(policy->Act(observation), Error);
  PolicyOptions none;
  none.candidates = 0;
  EXPECT_THROW(MakePolicy(SomeNetworks(), none), Error);
}

}  // namespace
}  // namespace doorforge

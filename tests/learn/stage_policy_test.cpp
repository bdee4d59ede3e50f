// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/learn/stage_policy.h"

#include <filesystem>
#include <limits>

#include <Eigen/Geometry>
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
  const Action memory = MakePolicy(ReadPolicy(folder).networks)->Act(observation);
  const Action loaded = LoadPolicy(folder)->Act(observation);
  EXPECT_EQ(memory.position_delta_m, loaded.position_delta_m);
  EXPECT_EQ(memory.world_from_hand_rotation, loaded.world_from_hand_rotation);
  EXPECT_NEAR((memory.world_from_hand_rotation * memory.world_from_hand_rotation.transpose() -
               Eigen::Matrix3d::Identity())
                  .norm(),
              0, 1e-6);
}

// The same scene elsewhere: joints as before, cloud and hand moved.
Observation Moved(Observation observation, const Eigen::Vector3f& by) {
  for (std::size_t i = 0; i < observation.cloud.xyz.size(); ++i)
    observation.cloud.xyz[i] += by[static_cast<Eigen::Index>(i % 3)];
  for (std::size_t k = 0; k < 3; ++k)
    observation.proprioception[25 + k] += by[static_cast<Eigen::Index>(k)];
  return observation;
}

Observation WithHand(Observation observation, const Eigen::Quaternionf& hand) {
  const std::array<float, 4> xyzw = {hand.x(), hand.y(), hand.z(), hand.w()};
  std::copy(xyzw.begin(), xyzw.end(), observation.proprioception.end() - 4);
  return observation;
}

TEST(StagePolicy, InTheHandsFrameItMovesAlikeWhereverTheDoorIs) {
  StageNetworks networks = SomeNetworks();
  const Observation here = WithHand(SomeObservation(), Eigen::Quaternionf::Identity());
  const Observation there = Moved(here, {0.25F, -0.5F, 0.125F});
  const auto difference = [&] {
    return (MakePolicy(networks)->Act(here).position_delta_m -
            MakePolicy(networks)->Act(there).position_delta_m)
        .norm();
  };
  EXPECT_GT(difference(), 1e-4);  // the world's frame
  networks.normalisation.frame = MotionFrame::kHand;
  networks.normalisation.cloud_centre_m = {};
  EXPECT_LT(difference(), 1e-5);
}

TEST(StagePolicy, InTheHandsFrameItTurnsTheHandFromWhereItIs) {
  StageNetworks networks = SomeNetworks();
  networks.normalisation.frame = MotionFrame::kHand;
  const Eigen::Quaternionf hand(Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, 3).normalized()));
  const Action plain =
      MakePolicy(networks)->Act(WithHand(SomeObservation(), Eigen::Quaternionf::Identity()));
  const Action turned = MakePolicy(networks)->Act(WithHand(SomeObservation(), hand));
  EXPECT_EQ(turned.position_delta_m, plain.position_delta_m);
  EXPECT_LT((turned.world_from_hand_rotation -
             plain.world_from_hand_rotation * hand.toRotationMatrix().cast<double>())
                .norm(),
            1e-5);
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

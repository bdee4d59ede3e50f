// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_set_factory.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/registry/run_policy_set.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

const std::string kPolicies = DOORFORGE_SOURCE_DIR "/data/policies/";

TEST(PolicySetFactory, TheExpertIsWhatTheRulesOfAnEpisodeAre) {
  const PolicySetFactory factory(BuiltInPolicies(), {});
  EXPECT_TRUE(factory.IsExpertAlone());
  const PolicySet set = factory.Make();
  EXPECT_NE(set.open, nullptr);
  EXPECT_EQ(set.handle, nullptr);
  EXPECT_EQ(set.grasp, nullptr);
  EXPECT_FALSE(UsesPointCloud(set));
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  const Scene scene = SampleScene(door, 3, 0);
  OpeningExpert opens;
  EXPECT_EQ(RunPolicySet({scene, door, robot}, set, nullptr).state_sha256,
            RunEpisode(scene, door, robot, opens, nullptr).state_sha256);
}

TEST(PolicySetFactory, WithSettingsForItTheExpertTurnsTheHandleDecisionByDecision) {
  PolicySettings settings;
  settings.handle_expert.emplace();
  const PolicySetFactory factory(BuiltInPolicies(), {}, settings);
  EXPECT_NE(factory.Make().handle, nullptr);
  EXPECT_TRUE(factory.IsExpertAlone());
}

TEST(PolicySetFactory, TrainedPoliciesComeFromTheirFoldersAndTheHandlerSaysWhenItIsDone) {
  const PolicyWords words{kPolicies + "opener", kPolicies + "handler", kPolicies + "grasper"};
  const PolicySetFactory factory(BuiltInPolicies(), words);
  EXPECT_FALSE(factory.IsExpertAlone());
  EXPECT_TRUE(factory.PredictsSwitch());
  const PolicySet set = factory.Make();
  ASSERT_NE(set.handle, nullptr);
  EXPECT_EQ(dynamic_cast<StageSwitch*>(set.handle.get()), set.handle_turned);
  ASSERT_NE(set.grasp, nullptr);
  EXPECT_TRUE(set.grasp->Explains());
  EXPECT_EQ(set.grasp_resolution_scale, 2);
  EXPECT_TRUE(UsesPointCloud(set));

  const PolicySetFactory told(BuiltInPolicies(), words, {}, SwitchSource::kSimulator);
  EXPECT_FALSE(told.PredictsSwitch());
  EXPECT_EQ(told.Make().handle_turned, nullptr);
}

TEST(PolicySetFactory, APolicyOfAnotherStageIsRefused) {
  const PolicySetFactory factory(BuiltInPolicies(), {.opener = kPolicies + "handler"});
  EXPECT_THROW(factory.Make(), Error);
}

// A grasp policy sees the closed door without the robot, and is told where its makers hold it.
TEST(PolicySetFactory, AGraspPolicyOfOnesOwnTakesHold) {
  class OfTheMakers : public GraspPolicy {
   public:
    std::optional<GraspAction> Choose(const GraspObservation& seen) override {
      for (const std::uint8_t label : seen.visible.label)
        EXPECT_NE(label, static_cast<std::uint8_t>(PointLabel::kRobot));
      EXPECT_EQ(seen.sample(Eigen::Vector3d::Zero(), 0).label.size(), 4096U);
      GraspAction action;
      action.world_from_hand_rotation =
          seen.privileged.world_from_tcp.linear() * seen.hand_from_tcp.linear().transpose();
      action.contact_m = seen.privileged.world_from_tcp * Eigen::Vector3d(0, 0, -kGraspInsertion);
      return action;
    }
  };
  PolicyRegistry registry = BuiltInPolicies();
  registry.Add(GraspPolicyRow{
      "makers", [](const PolicySettings&) { return std::make_unique<OfTheMakers>(); }});
  const PolicySet set = PolicySetFactory(registry, {.grasper = "makers"}).Make();
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  const Episode episode = RunPolicySet({SampleScene(door, 3, 0), door, robot}, set, nullptr);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/lone_policy.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/robot_model.h"

namespace doorforge {
namespace {

const std::string kFolder = DOORFORGE_SOURCE_DIR "/data/policies/";

// Points about the hand, which looks along the world's z.
Observation AroundHand(int points, const std::string& stream) {
  Observation seen;
  seen.proprioception[25] = 0.3F;
  seen.proprioception[27] = 0.9F;
  seen.proprioception[31] = 1;
  Rng rng(1, stream);
  for (int i = 0; i < 3 * points; ++i)
    seen.cloud.xyz.push_back(seen.proprioception[25 + static_cast<std::size_t>(i % 3)] +
                             static_cast<float>(rng.Uniform(-0.2, 0.2)));
  seen.cloud.label.assign(static_cast<std::size_t>(points), 0);
  return seen;
}

TEST(LonePolicy, AHandlerThatRemembersJoinsWhatWasSeenBefore) {
  LonePolicy handler(kFolder + "handler", Stage::kHandle);
  ASSERT_TRUE(handler.remembered().IsOn());
  const Observation now = AroundHand(1000, "now");
  EXPECT_THROW(handler.Act(now), Error);
  const LabelledCloud before = AroundHand(5000, "before").cloud;
  handler.Begin(before);
  const ActionVector found = ToVector(handler.Act(now));

  Observation joined = now;
  const Eigen::Vector3d tcp_m = Eigen::Vector3d(now.proprioception[25], 0, now.proprioception[27]) +
                                LoadMobileFranka().hand_from_tcp().translation();
  joined.cloud = JoinedCloud(now.cloud, before, tcp_m, {4096, handler.remembered().crop_radius_m});
  handler.Reset();
  EXPECT_EQ(ToVector(handler.ActOnJoined(joined)), found);
  EXPECT_THROW(handler.Act(now), Error);  // another episode: what was before is forgotten
  EXPECT_THROW(handler.Begin(LabelledCloud{}), Error);
}

TEST(LonePolicy, AnOpenerWantsAPictureWhereItIsToTellTheSide) {
  EXPECT_FALSE(LonePolicy(kFolder + "opener", Stage::kOpen).WantsPicture());
  PolicyOptions options;
  options.told.side = SideChoice::kAuto;
  LonePolicy opener(kFolder + "opener", Stage::kOpen, options);
  EXPECT_TRUE(opener.WantsPicture());
  EXPECT_FALSE(opener.Says());
  // where nobody has looked, each episode begins with the hinge on the left
  const Observation seen = AroundHand(4096, "seen");
  const ActionVector left = ToVector(LonePolicy(kFolder + "opener", Stage::kOpen).Act(seen));
  for (int episode = 0; episode < 2; ++episode) {
    opener.Reset();
    EXPECT_EQ(ToVector(opener.Act(seen)), left);
  }
}

TEST(LonePolicy, ThereIsNoneThatTakesHold) {
  EXPECT_THROW(LonePolicy(kFolder + "grasper", Stage::kGrasp), Error);
  EXPECT_TRUE(LonePolicy(kFolder + "handler", Stage::kHandle).Says());
  EXPECT_FALSE(LonePolicy("expert", Stage::kHandle).Says());
}

}  // namespace
}  // namespace doorforge

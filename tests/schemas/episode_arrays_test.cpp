// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode_arrays.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/error.h"

#include "shard_fixture.h"

namespace doorforge {
namespace {

using fixture::MakeEpisode;
using fixture::MembersOf;

class EpisodeArraysFile : public fixture::FolderTest {
 protected:
  ShardReader Write(std::vector<MemberBytes> members, std::uint64_t decisions = 3) {
    ShardWriter writer(folder_, {0, "open", "train", ""});
    writer.Add("ep0", decisions, std::move(members));
    writer.Commit();
    return ShardReader(folder_ / "shard-000000.index.json");
  }
};

TEST_F(EpisodeArraysFile, HoldEveryDecisionInOrder) {
  const Episode episode = MakeEpisode(1, 4, 17);
  const ShardReader reader = Write(MembersOf(episode), 4);
  const EpisodeArrays arrays = ViewEpisode(reader, 0);
  ASSERT_EQ(arrays.decisions, 4U);
  ASSERT_EQ(arrays.points, 17U);
  for (std::size_t t = 0; t < 4; ++t) {
    const Decision& decision = episode.decisions[t];
    EXPECT_TRUE(std::equal(decision.cloud.xyz.begin(), decision.cloud.xyz.end(),
                           arrays.cloud.begin() + static_cast<std::ptrdiff_t>(t * 51)));
    EXPECT_TRUE(std::equal(decision.cloud.label.begin(), decision.cloud.label.end(),
                           arrays.label.begin() + static_cast<std::ptrdiff_t>(t * 17)));
    EXPECT_TRUE(std::equal(decision.proprioception.begin(), decision.proprioception.end(),
                           arrays.proprio.begin() + static_cast<std::ptrdiff_t>(t * 32)));
    EXPECT_TRUE(std::equal(decision.action.begin(), decision.action.end(),
                           arrays.action.begin() + static_cast<std::ptrdiff_t>(t * 9)));
    EXPECT_EQ(arrays.joints[2 * t], static_cast<float>(decision.hinge_rad));
    EXPECT_EQ(arrays.joints[2 * t + 1], static_cast<float>(decision.handle_rad));
    EXPECT_EQ(arrays.score[t], static_cast<float>(decision.angle_gain_rad));
    EXPECT_TRUE(std::equal(decision.state.begin(), decision.state.end(),
                           arrays.state.begin() + static_cast<std::ptrdiff_t>(t * 14)));
  }
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(arrays.cloud.data()) % 64, 0U);
  EXPECT_EQ(ReadEpisodeMeta(reader, 0), EpisodeMetaToJson(episode));
}

TEST_F(EpisodeArraysFile, AreTheFeaturesThatAreDocumented) {
  const ShardReader reader = Write(MembersOf(MakeEpisode(1)));
  std::vector<std::string> documented = {"meta.json"};
  for (const EpisodeFeature& feature : EpisodeFeatures())
    documented.push_back(feature.name + ".npy");
  std::sort(documented.begin(), documented.end());
  std::vector<std::string> found;
  for (const ShardMember& member : reader.index().episodes[0].members) found.push_back(member.name);
  EXPECT_EQ(found, documented);
}

TEST_F(EpisodeArraysFile, OfBeforeHadNoState) {
  std::vector<MemberBytes> members = MembersOf(MakeEpisode(1));
  std::erase_if(members, [](const MemberBytes& member) { return member.name == "state.npy"; });
  const ShardReader reader = Write(members);
  const EpisodeArrays arrays = ViewEpisode(reader, 0);
  EXPECT_EQ(arrays.decisions, 3U);
  EXPECT_TRUE(arrays.state.empty());
}

TEST_F(EpisodeArraysFile, AreRefusedWhereTheirShapesDisagree) {
  std::vector<MemberBytes> members = MembersOf(MakeEpisode(1, 3));
  const std::vector<MemberBytes> other = MembersOf(MakeEpisode(1, 2));
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].name == "action.npy") members[i] = other[i];
  }
  const ShardReader reader = Write(members);
  try {
    ViewEpisode(reader, 0);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("ep0.action.npy: its shape does not fit"),
              std::string::npos);
  }
}

TEST(EncodeEpisode, RefusesEpisodesThatNoReaderCouldUse) {
  Episode empty = MakeEpisode(1, 0);
  EXPECT_THROW(MembersOf(empty), Error);
  Episode blind = MakeEpisode(1);
  blind.decisions[1].cloud = {};
  EXPECT_THROW(MembersOf(blind), Error);
  Episode unlabelled = MakeEpisode(1);
  unlabelled.decisions[2].cloud.label.pop_back();
  EXPECT_THROW(MembersOf(unlabelled), Error);
  Episode broken = MakeEpisode(1);
  broken.decisions[0].action[3] = NAN;
  EXPECT_THROW(MembersOf(broken), Error);
}

TEST(EncodeEpisode, AddsThePreviewOnlyIfThereIsOne) {
  const Episode episode = MakeEpisode(1);
  EXPECT_EQ(EncodeEpisode(episode, {}, "").size() + 1, EncodeEpisode(episode, {}, "png").size());
}

}  // namespace
}  // namespace doorforge

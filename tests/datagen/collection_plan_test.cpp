// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/datagen/collection_plan.h"

#include <map>
#include <set>

#include "doorforge/core/error.h"

#include "synthetic.h"

namespace doorforge {
namespace {

// Episode number to (door, split).
std::map<std::uint64_t, std::pair<std::size_t, std::string>> EpisodesOf(
    const CollectionPlan& plan) {
  std::map<std::uint64_t, std::pair<std::size_t, std::string>> episodes;
  for (const PlannedShard& shard : plan.shards) {
    for (const PlannedEpisode& episode : shard.episodes)
      EXPECT_TRUE(episodes.emplace(episode.number, std::pair(episode.door, shard.split)).second);
  }
  return episodes;
}

TEST(MakePlan, PlansEveryEpisodeOnceAndEveryDoorEquallyOften) {
  const auto doors = synthetic::Doors(7);
  const CollectionPlan plan = MakePlan(doors, 7 * 5 + 3, 1, {});
  std::map<std::size_t, int> opened;
  for (const auto& [number, place] : EpisodesOf(plan)) {
    ++opened[place.first];
    EXPECT_EQ(place.second, SplitNameOf(plan.sides[place.first]));
  }
  EXPECT_EQ(opened.size(), 7U);
  for (const auto& [door, count] : opened) EXPECT_TRUE(count == 5 || count == 6);
}

TEST(MakePlan, CutsShardsByPlannedEpisodes) {
  const CollectionPlan plan = MakePlan(synthetic::Doors(1), 25, 1, {.episodes_per_shard = 10});
  ASSERT_EQ(plan.shards.size(), 3U);
  EXPECT_EQ(plan.shards[0].episodes.size(), 10U);
  EXPECT_EQ(plan.shards[2].episodes.size(), 5U);
  EXPECT_EQ(plan.shards[2].number, 2);
  EXPECT_EQ(plan.shards[1].episodes[3].key, "ep000013");
}

TEST(MakePlan, KeepsItsBeginningWhenMoreEpisodesAreAskedFor) {
  const auto doors = synthetic::Doors(6);
  const auto few = EpisodesOf(MakePlan(doors, 20, 3, {}));
  const auto many = EpisodesOf(MakePlan(doors, 50, 3, {}));
  for (const auto& [number, place] : few) EXPECT_EQ(many.at(number), place);
}

TEST(MakePlan, DependsOnTheSeed) {
  const auto doors = synthetic::Doors(6);
  EXPECT_EQ(EpisodesOf(MakePlan(doors, 30, 3, {})), EpisodesOf(MakePlan(doors, 30, 3, {})));
  EXPECT_NE(EpisodesOf(MakePlan(doors, 30, 3, {})), EpisodesOf(MakePlan(doors, 30, 4, {})));
}

TEST(MakePlan, RefusesSettingsOutOfRange) {
  const auto doors = synthetic::Doors(2);
  EXPECT_THROW(MakePlan({}, 5, 1, {}), Error);
  EXPECT_THROW(MakePlan(doors, 0, 1, {}), Error);
  EXPECT_THROW(MakePlan(doors, 5, 1, {.episodes_per_shard = 0}), Error);
  EXPECT_THROW(MakePlan(doors, 5, 1, {.val_fraction = 0.7}), Error);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/collection_plan.h"

#include <algorithm>
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

TEST(MakePlan, PlansEveryEpisodeOnceOnTheSideOfItsDoor) {
  const auto doors = synthetic::Doors(7);
  const CollectionPlan plan = MakePlan(doors, 7 * 5 + 3, 1, {});
  const auto episodes = EpisodesOf(plan);
  EXPECT_EQ(episodes.size(), 38U);
  EXPECT_EQ(episodes.rbegin()->first, 37U);
  for (const auto& [number, place] : episodes)
    EXPECT_EQ(place.second, SplitNameOf(plan.sides[place.first]));
}

// Every body of a kind with every handle.
void AddKind(const std::string& category, const std::string& mechanism, int bodies, int handles,
             std::vector<DoorParts>& doors) {
  for (int b = 0; b < bodies; ++b) {
    for (int h = 0; h < handles; ++h) {
      const std::string body = category + "_body" + std::to_string(b);
      const std::string handle = category + "_" + mechanism + std::to_string(h);
      doors.push_back({body + "__" + handle, category, mechanism, synthetic::PartNamed(body),
                       synthetic::PartNamed(handle)});
    }
  }
}

// One category has 25 times the doors of another, as in the catalogue.
std::vector<DoorParts> UnequalCategories() {
  std::vector<DoorParts> doors;
  AddKind("interior", "lever", 19, 13, doors);
  AddKind("interior", "round", 19, 7, doors);
  AddKind("safe", "valve", 8, 5, doors);
  AddKind("safe", "key", 8, 2, doors);
  AddKind("window", "lever", 3, 5, doors);
  return doors;
}

// Largest minus smallest number of episodes, over everything that `name` tells apart.
template <class Name>
int Spread(const std::vector<DoorParts>& doors, const CollectionPlan& plan, Name&& name) {
  std::map<std::string, int> counts;
  for (const DoorParts& door : doors) {
    if (!name(door).empty()) counts[name(door)] = 0;
  }
  for (const auto& [number, place] : EpisodesOf(plan)) {
    if (!name(doors[place.first]).empty()) ++counts[name(doors[place.first])];
  }
  const auto [least, most] = std::minmax_element(
      counts.begin(), counts.end(), [](auto& a, auto& b) { return a.second < b.second; });
  return most->second - least->second;
}

TEST(MakePlan, GivesEveryCategoryMechanismBodyAndHandleItsEvenShare) {
  const auto doors = UnequalCategories();
  for (const std::uint64_t episodes : {1U, 17U, 300U, 1234U}) {
    const CollectionPlan plan = MakePlan(doors, episodes, 5, {});
    EXPECT_LE(Spread(doors, plan, [](const DoorParts& door) { return door.category; }), 1);
    for (const char* category : {"interior", "safe", "window"}) {
      EXPECT_LE(Spread(doors, plan,
                       [&](const DoorParts& door) {
                         return door.category == category ? door.mechanism : "";
                       }),
                1);
      for (const char* mechanism : {"lever", "round", "valve", "key"}) {
        const auto of_kind = [&](const DoorParts& door, const std::string& id) {
          return door.category == category && door.mechanism == mechanism ? id : "";
        };
        if (std::none_of(doors.begin(), doors.end(),
                         [&](const auto& door) { return !of_kind(door, "x").empty(); }))
          continue;
        EXPECT_LE(Spread(doors, plan, [&](auto& door) { return of_kind(door, door.body.id); }), 1);
        EXPECT_LE(Spread(doors, plan, [&](auto& door) { return of_kind(door, door.handle.id); }),
                  1);
      }
    }
  }
}

TEST(MakePlan, DoesNotDependOnTheOrderOfTheDoors) {
  const auto doors = UnequalCategories();
  const std::vector<DoorParts> backwards(doors.rbegin(), doors.rend());
  const auto there = EpisodesOf(MakePlan(doors, 200, 5, {}));
  const auto back = EpisodesOf(MakePlan(backwards, 200, 5, {}));
  for (const auto& [number, place] : there)
    EXPECT_EQ(backwards[back.at(number).first].door_id, doors[place.first].door_id);
}

TEST(MakePlan, OpensNewDoorsBeforeItOpensSomeAgain) {
  std::vector<DoorParts> doors;
  AddKind("interior", "lever", 19, 13, doors);
  std::set<std::size_t> opened;
  for (const auto& [number, place] : EpisodesOf(MakePlan(doors, 19 * 13, 2, {})))
    opened.insert(place.first);
  EXPECT_GT(opened.size(), 19U * 13U * 8 / 10);
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

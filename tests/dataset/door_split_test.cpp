// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/door_split.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

#include "synthetic.h"

namespace doorforge {
namespace {

using synthetic::PartNamed;

// `count` doors of random pairs among the given numbers of bodies and handles.
std::vector<DoorParts> RandomDoors(int count, int bodies, int handles, std::uint64_t seed) {
  Rng rng(seed, "doors");
  std::vector<DoorParts> doors;
  for (int i = 0; i < count; ++i)
    doors.push_back(
        {"door" + std::to_string(i), i % 3 == 0 ? "window" : "interior", "lever",
         PartNamed("b" + std::to_string(rng.Index(static_cast<std::uint32_t>(bodies)))),
         PartNamed("h" + std::to_string(rng.Index(static_cast<std::uint32_t>(handles))))});
  return doors;
}

long CountVal(const std::vector<DoorSide>& sides) {
  return std::count(sides.begin(), sides.end(), DoorSide::kVal);
}

TEST(SplitDoors, NeverPutsAPartOnBothSides) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::vector<DoorParts> doors = RandomDoors(60, 20 + 4 * static_cast<int>(seed), 30, seed);
    const std::vector<DoorSide> sides = SplitDoors(doors, 0.2, seed);
    std::map<std::string, std::set<DoorSide>> sides_of;
    for (std::size_t i = 0; i < doors.size(); ++i) {
      sides_of[doors[i].body.sha256].insert(sides[i]);
      sides_of[doors[i].handle.sha256].insert(sides[i]);
    }
    for (const auto& [part, both] : sides_of) EXPECT_EQ(both.size(), 1U) << part;
  }
}

TEST(SplitDoors, KeepsCopiesOfAPartAtAnotherSizeOnOneSide) {
  const ShapeDescriptor shape(13, 0.2);
  const ShapeDescriptor nearly(13, 0.2001);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::vector<DoorParts> doors = RandomDoors(60, 1000000, 1000000, seed);
    doors[7].body.shape = shape;
    doors[31].body.shape = nearly;
    doors[12].handle.shape = nearly;
    doors[50].handle.shape = shape;
    const std::vector<DoorSide> sides = SplitDoors(doors, 0.3, seed);
    EXPECT_EQ(sides[7], sides[31]);
    EXPECT_EQ(sides[12], sides[50]);
  }
}

TEST(SplitDoors, GivesTheWantedShareOfDoorsThatShareNothing) {
  std::vector<DoorParts> doors;
  for (int i = 0; i < 100; ++i) {
    const std::string n = std::to_string(i);
    doors.push_back(
        {n, i < 60 ? "interior" : "safe", "lever", PartNamed("b" + n), PartNamed("h" + n)});
  }
  const std::vector<DoorSide> sides = SplitDoors(doors, 0.1, 3);
  EXPECT_EQ(std::count(sides.begin(), sides.begin() + 60, DoorSide::kVal), 6);
  EXPECT_EQ(std::count(sides.begin() + 60, sides.end(), DoorSide::kVal), 4);
}

TEST(SplitDoors, LetsAllTrainWhereEveryBodyMeetsEveryHandle) {
  std::vector<DoorParts> doors;
  for (int b = 0; b < 4; ++b) {
    for (int h = 0; h < 4; ++h)
      doors.push_back({std::to_string(4 * b + h), "interior", "lever",
                       PartNamed("b" + std::to_string(b)), PartNamed("h" + std::to_string(h))});
  }
  EXPECT_EQ(CountVal(SplitDoors(doors, 0.5, 3)), 0);
}

TEST(SplitDoors, KeepsHalfOfEachKindForTraining) {
  // one interior door among many safes: it must not be held out
  std::vector<DoorParts> doors = {{"only", "interior", "lever", PartNamed("b"), PartNamed("h")}};
  for (int i = 0; i < 20; ++i) {
    const std::string n = std::to_string(i);
    doors.push_back({"safe" + n, "safe", "key", PartNamed("b" + n), PartNamed("h" + n)});
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    EXPECT_EQ(SplitDoors(doors, 0.5, seed)[0], DoorSide::kTrain);
}

TEST(SplitDoors, DependsOnTheSeedAndNotOnTheOrder) {
  const std::vector<DoorParts> doors = RandomDoors(60, 200, 200, 1);
  std::vector<DoorParts> reversed(doors.rbegin(), doors.rend());
  std::vector<DoorSide> sides = SplitDoors(doors, 0.3, 1);
  std::vector<DoorSide> mirrored = SplitDoors(reversed, 0.3, 1);
  std::reverse(mirrored.begin(), mirrored.end());
  EXPECT_EQ(sides, mirrored);
  EXPECT_NE(sides, SplitDoors(doors, 0.3, 2));
}

TEST(SplitDoors, RefusesDoubleIdsAndSharesOutOfRange) {
  const std::vector<DoorParts> doors = {{"a", "", "", {}, {}}, {"a", "", "", {}, {}}};
  EXPECT_THROW(SplitDoors(doors, 0.1, 1), Error);
  EXPECT_THROW(SplitDoors({}, 0.6, 1), Error);
  EXPECT_TRUE(SplitDoors({}, 0.5, 1).empty());
}

}  // namespace
}  // namespace doorforge

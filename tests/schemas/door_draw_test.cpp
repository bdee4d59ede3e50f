// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_draw.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

DoorIdentity Door(Category category, const std::string& body, const std::string& handle,
                  Mechanism mechanism = Mechanism::kLever) {
  DoorIdentity door;
  door.id = body + "__" + handle;
  door.category = category;
  door.mechanism = mechanism;
  door.body.id = body;
  door.handle.id = handle;
  return door;
}

std::string Numbered(const std::string& name, int number) {
  return name + (number < 10 ? "_00" : number < 100 ? "_0" : "_") + std::to_string(number);
}

// Every body with every handle. The handle's mechanism goes by thirds of the list.
std::vector<DoorIdentity> Grid(Category category, int bodies, int handles) {
  constexpr std::array kMechanisms = {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone};
  std::vector<DoorIdentity> doors;
  for (int b = 0; b < bodies; ++b) {
    for (int h = 0; h < handles; ++h)
      doors.push_back(Door(category, Numbered("body", b), Numbered("handle", h),
                           kMechanisms.at(static_cast<std::size_t>(3 * h / handles))));
  }
  return doors;
}

// The largest difference between the uses of any two of the parts that occur.
template <class PartOf>
int Unevenness(const std::vector<DoorIdentity>& doors, const std::vector<std::size_t>& drawn,
               const PartOf& part_of) {
  std::map<std::string, int> uses;
  for (const DoorIdentity& door : doors) uses[part_of(door)] = 0;
  for (const std::size_t door : drawn) ++uses[part_of(doors[door])];
  const auto [least, most] =
      std::ranges::minmax_element(uses, {}, [](const auto& entry) { return entry.second; });
  return most->second - least->second;
}

const std::string& BodyOf(const DoorIdentity& door) { return door.body.id; }
const std::string& HandleOf(const DoorIdentity& door) { return door.handle.id; }

TEST(DrawDoors, TriesEveryBodyAndHandleOfAGridAsEvenlyAsAnyNumberAllows) {
  // sizes with and without common factors, and those of the catalogue's sides
  const std::vector<std::pair<int, int>> sizes = {{1, 7},   {7, 1},   {6, 4},  {8, 8},  {5, 11},
                                                  {17, 27}, {160, 8}, {10, 9}, {9, 12}, {12, 18}};
  for (const auto& [bodies, handles] : sizes) {
    const auto doors = Grid(Category::kSafe, bodies, handles);
    for (std::size_t n = 1; n <= doors.size(); ++n) {
      const auto drawn = DrawDoors(doors, n);
      ASSERT_EQ(std::set(drawn.begin(), drawn.end()).size(), n);
      ASSERT_LE(Unevenness(doors, drawn, HandleOf), 1) << bodies << " x " << handles << ", " << n;
      ASSERT_LE(Unevenness(doors, drawn, BodyOf), 1) << bodies << " x " << handles << ", " << n;
    }
  }
}

TEST(DrawDoors, FewDoorsHaveHandlesOfAllMechanisms) {
  const auto doors = Grid(Category::kStorageFurniture, 40, 30);
  for (std::size_t n = 4; n <= 30; ++n) {
    std::map<Mechanism, int> uses;
    for (const std::size_t door : DrawDoors(doors, n)) ++uses[doors[door].mechanism];
    for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone})
      EXPECT_NEAR(uses[mechanism], static_cast<double>(n) / 3, 2) << n;
  }
}

TEST(DrawDoors, FewerAreTheBeginningOfMore) {
  const auto doors = Grid(Category::kWindow, 9, 6);
  std::vector<std::size_t> fewer;
  for (std::size_t n = 1; n <= doors.size(); ++n) {
    const auto more = DrawDoors(doors, n);
    EXPECT_TRUE(std::ranges::includes(more, fewer)) << n;
    fewer = more;
  }
}

TEST(DrawDoors, EachCategoryIsDrawnByItself) {
  auto doors = Grid(Category::kCar, 6, 4);
  const auto cars = doors.size();
  for (const DoorIdentity& door : Grid(Category::kSafe, 3, 2)) doors.push_back(door);
  const auto drawn = DrawDoors(doors, 7);
  const auto of_cars = std::ranges::count_if(drawn, [&](std::size_t i) { return i < cars; });
  EXPECT_EQ(of_cars, 7);
  EXPECT_EQ(drawn.size(), 7u + 6u) << "there are six safes, and all are tried";
  EXPECT_TRUE(std::ranges::is_sorted(drawn));
}

TEST(DrawDoors, TheOrderOfTheDoorsDoesNotMatter) {
  auto doors = Grid(Category::kInterior, 17, 27);
  const auto ids = [&] {
    std::set<std::string> drawn;
    for (const std::size_t door : DrawDoors(doors, 40)) drawn.insert(doors[door].id);
    return drawn;
  };
  const auto before = ids();
  std::ranges::shuffle(doors, std::mt19937(5));
  EXPECT_EQ(ids(), before);
}

TEST(DrawDoors, OfDoorsThatAreNoGridNoHandleIsLeftOutWhileAnotherIsDrawnTwice) {
  // every body has two handles of its own
  std::vector<DoorIdentity> doors;
  for (int b = 0; b < 9; ++b) {
    doors.push_back(Door(Category::kCar, Numbered("body", b), Numbered("handle", b)));
    doors.push_back(Door(Category::kCar, Numbered("body", b), Numbered("handle", (b + 1) % 9)));
  }
  for (std::size_t n = 1; n <= doors.size(); ++n)
    EXPECT_LE(Unevenness(doors, DrawDoors(doors, n), HandleOf), 1) << n;
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/side_classifier.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/schemas/mirror.h"

namespace doorforge {
namespace {

struct SeenDoor {
  LabelledCloud cloud;
  Eigen::Vector3f hand_m;
};

// A leaf without thickness; the hand holds it near its left or right edge, as seen by who stands
// before it: a handle is where the hinge is not.
SeenDoor DoorHinged(HingeSide side, Rng& rng) {
  const double width = rng.Uniform(0.6, 1.0);
  const double height = rng.Uniform(0.8, 2.0);
  const double to_handle = rng.Uniform(0.7, 0.95) * width;
  const double sign = side == HingeSide::kLeft ? 1 : -1;  // the world's y points to the right
  SeenDoor door;
  for (int i = 0; i < 2000; ++i) {
    door.cloud.xyz.push_back(0);
    door.cloud.xyz.push_back(static_cast<float>(sign * rng.Uniform(0, width)));
    door.cloud.xyz.push_back(static_cast<float>(rng.Uniform(0, height)));
  }
  door.cloud.label.assign(2000, 0);
  door.hand_m = {0.15F, static_cast<float>(sign * to_handle), static_cast<float>(height / 2)};
  return door;
}

std::vector<SideExample> Examples(int count, Rng& rng) {
  std::vector<SideExample> examples;
  for (int i = 0; i < count; ++i) {
    const HingeSide side = i % 4 == 0 ? HingeSide::kRight : HingeSide::kLeft;
    const SeenDoor door = DoorHinged(side, rng);
    examples.push_back({SideNumbersOf(door.cloud.xyz, door.hand_m), side});
  }
  return examples;
}

TEST(SideClassifier, TellsTheSideOfDoorsThatItHasNotSeen) {
  Rng rng(1, "test/side");
  const std::optional<SideClassifier> classifier = FitSideClassifier(Examples(60, rng));
  ASSERT_TRUE(classifier);
  for (int i = 0; i < 60; ++i) {
    const HingeSide side = i % 2 == 0 ? HingeSide::kLeft : HingeSide::kRight;
    const SeenDoor door = DoorHinged(side, rng);
    const double odds = classifier->LogOddsOfLeft(SideNumbersOf(door.cloud.xyz, door.hand_m));
    EXPECT_EQ(odds > 0, side == HingeSide::kLeft) << i;
  }
}

TEST(SideClassifier, GivesAMirrorImageTheOppositeAnswer) {
  Rng rng(2, "test/side");
  const std::optional<SideClassifier> classifier = FitSideClassifier(Examples(40, rng));
  for (int i = 0; i < 20; ++i) {
    const SeenDoor door = DoorHinged(HingeSide::kLeft, rng);
    const Eigen::Vector3f mirrored = door.hand_m.cwiseProduct(Eigen::Vector3f(1, -1, 1));
    const SideNumbers one = SideNumbersOf(door.cloud.xyz, door.hand_m);
    const SideNumbers other = SideNumbersOf(MirroredSideways(door.cloud).xyz, mirrored);
    EXPECT_EQ(classifier->LogOddsOfLeft(one), -classifier->LogOddsOfLeft(other));
  }
}

TEST(SideClassifier, DoesNotDependOnTheOrderOfThePoints) {
  Rng rng(3, "test/side");
  const SeenDoor door = DoorHinged(HingeSide::kLeft, rng);
  std::vector<float> reversed;
  for (std::size_t i = door.cloud.xyz.size(); i > 0; i -= 3)
    reversed.insert(reversed.end(), door.cloud.xyz.begin() + static_cast<std::ptrdiff_t>(i) - 3,
                    door.cloud.xyz.begin() + static_cast<std::ptrdiff_t>(i));
  const SideNumbers one = SideNumbersOf(door.cloud.xyz, door.hand_m);
  const SideNumbers other = SideNumbersOf(reversed, door.hand_m);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-4) << i;
}

TEST(SideClassifier, WantsTwentyDoorsAndAPoint) {
  Rng rng(4, "test/side");
  EXPECT_FALSE(FitSideClassifier(Examples(19, rng)));
  EXPECT_TRUE(FitSideClassifier(Examples(20, rng)));
  EXPECT_THROW(SideNumbersOf({}, {0, 0, 0}), Error);
}

class SideFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("side_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(SideFile, IsReadAsItWasWritten) {
  Rng rng(5, "test/side");
  const std::optional<SideClassifier> classifier = FitSideClassifier(Examples(30, rng));
  EXPECT_FALSE(ReadSideClassifier(folder_));
  WriteSideClassifier(folder_, classifier, "a");
  EXPECT_EQ(ReadSideClassifier(folder_)->weight, classifier->weight);
  WriteSideClassifier(folder_, std::nullopt, "a");
  EXPECT_FALSE(ReadSideClassifier(folder_));
}

}  // namespace
}  // namespace doorforge

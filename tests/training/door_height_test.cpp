// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/door_height.h"

#include <filesystem>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// A hundred and one points, one a centimetre, from the floor up, and two that no door has.
std::vector<float> AMetreWithNoise() {
  std::vector<float> xyz = {0, 0, -9, 0, 0, 9};
  for (int i = 0; i <= 100; ++i) {
    xyz.push_back(5);
    xyz.push_back(-5);
    xyz.push_back(0.01F * static_cast<float>(i));
  }
  return xyz;
}

TEST(HeightInView, LeavesOutOneInFiftyAtEitherEnd) {
  EXPECT_NEAR(HeightInView(AMetreWithNoise()), 0.98, 1e-6);  // two of 103 at either end
  EXPECT_THROW(HeightInView({}), Error);
}

TEST(LearnedHeights, KnowsWhatLiesBetweenAndATenthBeyond) {
  std::vector<double> heights;
  for (int i = 0; i < 20; ++i) heights.push_back(2 + 0.01 * i);
  const std::optional<LearnedHeights> learned = FitHeights(heights);
  EXPECT_DOUBLE_EQ(learned->least_m, 2);
  EXPECT_DOUBLE_EQ(learned->most_m, 2.19);
  for (const double known : {1.81, 2.0, 2.1, 2.4}) EXPECT_TRUE(learned->Knows(known)) << known;
  for (const double foreign : {0.5, 1.79, 2.42}) EXPECT_FALSE(learned->Knows(foreign)) << foreign;
  heights.pop_back();
  EXPECT_FALSE(FitHeights(heights));
}

TEST(LearnedHeights, AreReadAsTheyWereWrittenOrRefused) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("heights_test_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  EXPECT_FALSE(ReadHeights(folder));
  WriteHeights(folder, LearnedHeights{1.5, 2.25}, "a");
  EXPECT_EQ(ReadHeights(folder)->least_m, 1.5);
  EXPECT_EQ(ReadHeights(folder)->most_m, 2.25);
  WriteHeights(folder, LearnedHeights{2.25, 1.5}, "a");
  EXPECT_THROW(ReadHeights(folder), Error);
  CommitFile(folder / "heights.safetensors", "no tensors");
  EXPECT_THROW(ReadHeights(folder), Error);
  WriteHeights(folder, std::nullopt, "a");
  EXPECT_FALSE(ReadHeights(folder));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace doorforge

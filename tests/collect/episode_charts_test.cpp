// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/episode_charts.h"

#include <cstddef>
#include <utility>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// Episodes of one category, some opened to 10 and some to 80 deg.
EpisodeDescription Described(int narrow, int wide) {
  EpisodeGroup group;
  for (int i = 0; i < narrow; ++i) group.hinge.Add(0.175);
  for (int i = 0; i < wide; ++i) group.hinge.Add(1.4);
  EpisodeDescription description;
  description.stages.push_back({.stage = "open", .by_category = {{"car", group}}});
  return description;
}

// Pixels of the left and of the right half that are bars: more blue than red by far.
std::pair<int, int> Bars(const Picture& picture) {
  std::pair<int, int> count{0, 0};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto* pixel = &picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x)];
      if (pixel[2] > pixel[0] + 80) ++(x < picture.width / 2 ? count.first : count.second);
    }
  }
  return count;
}

TEST(EpisodeCharts, BarsAreAsHighAsThereAreEpisodes) {
  const auto [narrow, wide] = Bars(EpisodeCharts(Described(10, 30)));
  ASSERT_GT(narrow, 0);
  EXPECT_NEAR(static_cast<double>(wide) / narrow, 3, 0.3);
}

TEST(EpisodeCharts, EachStageAndCategoryHasATile) {
  EpisodeDescription description = Described(1, 1);
  const auto one = Bars(EpisodeCharts(description));
  description.stages.push_back(description.stages.front());
  const auto two = Bars(EpisodeCharts(description));
  EXPECT_EQ(two.first, one.first + one.second);  // the left half is the picture that was alone
  EXPECT_EQ(two.second, two.first);
}

TEST(EpisodeCharts, WithoutEpisodesThereIsNothingToDraw) { EXPECT_THROW(EpisodeCharts({}), Error); }

}  // namespace
}  // namespace doorforge

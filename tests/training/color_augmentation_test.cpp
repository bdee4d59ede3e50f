// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "color_augmentation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/rng.h"

#include "door_cloud.h"

namespace doorforge::internal {
namespace {

using Color = std::array<double, 3>;

Color ColorAt(const CloudGeometry& geometry, std::size_t point) {
  const std::uint8_t* rgb = &geometry.rgb.at(3 * point);
  return {double(rgb[0]), double(rgb[1]), double(rgb[2])};
}

double Apart(const Color& one, const Color& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}

// A door in colours from `darkest` up to 20 steps brighter, each channel by itself.
std::shared_ptr<const CloudGeometry> Painted(int darkest) {
  const std::vector<float> cloud = testing::DoorCloud(3, 0.2);
  std::vector<std::uint8_t> rgb(cloud.size());
  Rng rng(4, "test/paint");
  for (std::uint8_t& channel : rgb)
    channel = static_cast<std::uint8_t>(static_cast<std::uint32_t>(darkest) + rng.Index(21));
  return std::make_shared<const CloudGeometry>(BuildGeometry({cloud, rgb}, {{}, 0.5F}));
}

TEST(ColorAugmentation, TurnsHuesTogetherAndLowersTheContrast) {
  const auto painted = Painted(118);  // no channel is clipped, whatever is drawn
  Rng rng(1, "test");
  double lowest = 1;
  double highest = 0;
  for (int draw = 0; draw < 50; ++draw) {
    const auto recolored = Recolored(painted, rng);
    EXPECT_EQ(recolored->xyz, painted->xyz);
    EXPECT_EQ(recolored->levels[0].member, painted->levels[0].member);
    ASSERT_EQ(recolored->rgb.size(), painted->rgb.size());
    // a rotation and one factor: all distances shrink alike, but for rounding by half a step
    double before = 0;
    double after = 0;
    for (std::size_t i = 1; i < painted->rgb.size() / 3; ++i) {
      before += Apart(ColorAt(*painted, i), ColorAt(*painted, 0));
      after += Apart(ColorAt(*recolored, i), ColorAt(*recolored, 0));
    }
    const double factor = after / before;
    EXPECT_LT(factor, 1.05);
    for (std::size_t i = 1; i < 40; ++i)
      EXPECT_NEAR(Apart(ColorAt(*recolored, i), ColorAt(*recolored, 0)),
                  factor * Apart(ColorAt(*painted, i), ColorAt(*painted, 0)), 2.5);
    lowest = std::min(lowest, factor);
    highest = std::max(highest, factor);
  }
  EXPECT_LT(lowest, 0.15);
  EXPECT_GT(highest, 0.85);
}

TEST(ColorAugmentation, KeepsGreysGreyAndMovesTheirBrightness) {
  auto grey = std::make_shared<CloudGeometry>(*Painted(118));
  std::fill(grey->rgb.begin(), grey->rgb.end(), std::uint8_t{128});
  Rng rng(2, "test");
  double darkest = 255;
  double brightest = 0;
  for (int draw = 0; draw < 50; ++draw) {
    const Color color = ColorAt(*Recolored(grey, rng), 7);
    EXPECT_LE(std::abs(color[0] - color[1]), 1);
    EXPECT_LE(std::abs(color[0] - color[2]), 1);
    darkest = std::min(darkest, color[0]);
    brightest = std::max(brightest, color[0]);
  }
  EXPECT_LT(darkest, 80);
  EXPECT_GE(darkest, 63);
  EXPECT_GT(brightest, 176);
  EXPECT_LE(brightest, 192);
}

TEST(ColorAugmentation, ClipsWhatWouldBeDarkerThanBlackOrBrighterThanWhite) {
  auto stripes = std::make_shared<CloudGeometry>(*Painted(0));
  for (std::size_t i = 0; i < stripes->rgb.size(); ++i) stripes->rgb[i] = i / 3 % 2 == 0 ? 0 : 255;
  Rng rng(3, "test");
  for (int draw = 0; draw < 50; ++draw) {
    const auto recolored = Recolored(stripes, rng);
    EXPECT_LE(ColorAt(*recolored, 0)[0], ColorAt(*recolored, 1)[0] + 1) << "none wraps around";
  }
}

TEST(ColorAugmentation, IsOfTrainingAloneAndAsTheConfigSays) {
  const auto painted = Painted(118);
  const auto after = [&](SampleSet set, bool colors, bool augments) {
    TrainConfig config;
    config.colors = colors;
    config.augment_colors = augments;
    Geometries geometries = {painted, painted};
    Recolor(config, {set, {4, 9}, 17}, 2, geometries);
    return geometries;
  };
  EXPECT_EQ(after(SampleSet::kValidation, true, true)[0], painted);
  EXPECT_EQ(after(SampleSet::kTrain, true, false)[0], painted);
  EXPECT_EQ(after(SampleSet::kTrain, false, true)[0], painted);
  const Geometries recolored = after(SampleSet::kTrain, true, true);
  EXPECT_NE(recolored[0]->rgb, painted->rgb);
  EXPECT_NE(recolored[0]->rgb, recolored[1]->rgb) << "each sample has a draw of its own";
  TrainConfig config;
  config.colors = true;
  Geometries own_share = {painted};
  Recolor(config, {SampleSet::kTrain, {9}, 17}, 1, own_share);
  EXPECT_EQ(own_share[0]->rgb, recolored[1]->rgb) << "whichever part of the batch is shown";
}

}  // namespace
}  // namespace doorforge::internal

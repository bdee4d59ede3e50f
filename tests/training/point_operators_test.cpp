// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/point_operators.h"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

#include "encoder_checks.h"

namespace doorforge {
namespace {

// Points on a coarse grid: many equal distances, and a count that fills no vector register.
PointColumns GridPoints(std::size_t count) {
  Rng rng(1, "test/grid");
  std::vector<float> xyz;
  for (std::size_t i = 0; i < 3 * count; ++i)
    xyz.push_back(0.1F * static_cast<float>(rng.Index(9)));
  return ToColumns(xyz, {0, 0, 0});
}

float Squared(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  const float dx = a[0] - b[0];
  const float dy = a[1] - b[1];
  const float dz = a[2] - b[2];
  return dx * dx + dy * dy + dz * dz;
}

TEST(PointOperators, FarthestPointsFollowTheDefinitionWithTiesToTheLowestIndex) {
  const PointColumns points = GridPoints(701);
  std::vector<float> nearest(points.size(), std::numeric_limits<float>::max());
  std::vector<std::uint16_t> expected = {0};
  while (expected.size() < 300) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = std::min(nearest[i], Squared(points[i], points[expected.back()]));
      if (nearest[i] > nearest[best]) best = i;
    }
    expected.push_back(static_cast<std::uint16_t>(best));
  }
  for (const InstructionSet set : testing::SupportedSets())
    EXPECT_EQ(FarthestPoints(points, 300, set), expected) << NameOf(set);
}

TEST(PointOperators, FarthestPointsOfALineHalveIt) {
  std::vector<float> xyz;
  for (int i = 0; i <= 8; ++i) xyz.insert(xyz.end(), {static_cast<float>(i), 0, 0});
  const PointColumns line = ToColumns(xyz, {0, 0, 0});
  EXPECT_EQ(FarthestPoints(line, 5, InstructionSet::kBaseline),
            (std::vector<std::uint16_t>{0, 8, 4, 2, 6}));
  EXPECT_THROW(FarthestPoints(line, 10, InstructionSet::kBaseline), Error);
}

TEST(PointOperators, BallsHoldTheFirstPointsStrictlyInside) {
  const PointColumns points = GridPoints(701);
  for (const InstructionSet set : testing::SupportedSets()) {
    for (std::size_t c = 0; c < 50; ++c) {
      std::vector<std::uint16_t> expected;
      for (std::size_t i = 0; i < points.size() && expected.size() < 32; ++i) {
        if (Squared(points[i], points[c]) < 0.3F * 0.3F)
          expected.push_back(static_cast<std::uint16_t>(i));
      }
      EXPECT_EQ(PointsWithin(points, points[c], 0.3F, 32, set), expected) << NameOf(set);
    }
  }
}

TEST(PointOperators, InterpolationWeightsAreInverseSquaredDistances) {
  const PointColumns points =
      ToColumns(std::vector<float>{9, 9, 9, 2, 0, 0, 0, 1, 0, 0, 0, 4, 0, 1, 0}, {0, 0, 0});
  const NearestThree nearest = ThreeNearest(points, {0, 0, 0});
  EXPECT_EQ(nearest.index, (std::array<std::uint16_t, 3>{2, 4, 1}));  // 1, 1 (tie), 4
  EXPECT_NEAR(nearest.weight[0], 4.0 / 9, 1e-6);
  EXPECT_NEAR(nearest.weight[1], 4.0 / 9, 1e-6);
  EXPECT_NEAR(nearest.weight[2], 1.0 / 9, 1e-6);
  const NearestThree same = ThreeNearest(points, {2, 0, 0});
  EXPECT_EQ(same.index[0], 1);
  EXPECT_NEAR(same.weight[0], 1, 1e-6);
}

}  // namespace
}  // namespace doorforge

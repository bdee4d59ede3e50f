// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/farthest_point_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

// The textbook algorithm, with the contract's arithmetic and tie-break.
std::vector<std::int32_t> PlainFarthestPoints(const std::vector<float>& xyz, int count, int start) {
  const std::size_t size = xyz.size() / 3;
  std::vector<float> distance(size, std::numeric_limits<float>::infinity());
  std::vector<std::int32_t> taken = {start};
  while (taken.size() < static_cast<std::size_t>(count)) {
    const auto last = static_cast<std::size_t>(taken.back());
    distance[last] = -1;
    for (std::size_t i = 0; i < size; ++i) {
      const float dx = xyz[3 * i] - xyz[3 * last];
      const float dy = xyz[3 * i + 1] - xyz[3 * last + 1];
      const float dz = xyz[3 * i + 2] - xyz[3 * last + 2];
      distance[i] = std::min(distance[i], (dx * dx + dy * dy) + dz * dz);
    }
    taken.push_back(static_cast<std::int32_t>(std::max_element(distance.begin(), distance.end()) -
                                              distance.begin()));
  }
  return taken;
}

std::vector<float> RandomCloud(int count, std::uint64_t seed) {
  Rng rng(seed, "cloud");
  std::vector<float> xyz;
  for (int i = 0; i < count; ++i) {
    xyz.push_back(static_cast<float>(rng.Uniform()));
    xyz.push_back(static_cast<float>(rng.Uniform()));
    xyz.push_back(static_cast<float>(0.2 * rng.Uniform()));
  }
  return xyz;
}

// Whole-number coordinates: nearly every distance occurs many times.
std::vector<float> GridCloud(int side, int count, std::uint64_t seed) {
  Rng rng(seed, "grid");
  std::vector<float> xyz;
  for (int i = 0; i < 3 * count; ++i)
    xyz.push_back(static_cast<float>(rng.Index(static_cast<std::uint32_t>(side))));
  return xyz;
}

std::vector<SimdLevel> Levels() {
  std::vector<SimdLevel> levels;
  for (const SimdLevel level : {SimdLevel::kBaseline, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level <= BestSimdLevel()) levels.push_back(level);
  }
  return levels;
}

void ExpectPlain(const std::vector<float>& xyz, int count, int start) {
  const std::vector<std::int32_t> plain = PlainFarthestPoints(xyz, count, start);
  for (const SimdLevel level : Levels())
    EXPECT_EQ(FarthestPoints(xyz, count, start, level), plain)
        << "level " << static_cast<int>(level) << ", " << xyz.size() / 3 << " points";
}

TEST(FarthestPointSampling, EqualsThePlainAlgorithmOnRandomClouds) {
  for (const int size : {1, 2, 15, 16, 17, 511, 512, 513, 1500, 6000})
    ExpectPlain(RandomCloud(size, 1), std::min(size, 300), size / 3);
}

TEST(FarthestPointSampling, TakesTheLowestIndexAmongEqualDistances) {
  ExpectPlain(GridCloud(9, 3000, 2), 700, 17);
  ExpectPlain(GridCloud(2, 2000, 3), 500, 1999);
}

TEST(FarthestPointSampling, EqualsThePlainAlgorithmOnLinesAndPlanes) {
  std::vector<float> line;
  std::vector<float> plane;
  for (int i = 0; i < 2000; ++i) {
    for (const float c : {static_cast<float>(i % 500), 1.0F, 2.0F}) line.push_back(c);
    for (const float c :
         {0.25F * static_cast<float>(i % 40), 0.25F * static_cast<float>(i / 40), -3.0F})
      plane.push_back(c);
  }
  ExpectPlain(line, 900, 3);
  ExpectPlain(plane, 900, 0);
}

TEST(FarthestPointSampling, TakesEveryPointOnceEvenIfAllCoincide) {
  std::vector<float> same;
  for (int i = 0; i < 1200; ++i) same.insert(same.end(), {0.5F, -1.0F, 2.0F});
  ExpectPlain(same, 1200, 700);
  std::vector<std::int32_t> taken = FarthestPoints(same, 1200, 700);
  std::sort(taken.begin(), taken.end());
  std::vector<std::int32_t> all(1200);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(taken, all);
}

TEST(FarthestPointSampling, SurvivesAHalfOfDuplicatesInOnePlace) {
  std::vector<float> xyz = RandomCloud(1500, 5);
  for (int i = 0; i < 1500; ++i) xyz.insert(xyz.end(), {0.5F, 0.5F, 0.1F});
  ExpectPlain(xyz, 1600, 0);
}

TEST(FarthestPointSampling, RefusesArgumentsOutOfRange) {
  const std::vector<float> xyz = RandomCloud(10, 6);
  EXPECT_THROW(FarthestPoints(xyz, 11, 0), Error);
  EXPECT_THROW(FarthestPoints(xyz, 0, 0), Error);
  EXPECT_THROW(FarthestPoints(xyz, 5, 10), Error);
  EXPECT_THROW(FarthestPoints(xyz, 5, -1), Error);
  EXPECT_THROW(FarthestPoints(std::span(xyz).first(29), 5, 0), Error);
  std::vector<float> broken = xyz;
  broken[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(FarthestPoints(broken, 5, 0), Error);
}

}  // namespace
}  // namespace doorforge

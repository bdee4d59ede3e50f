// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/rng.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

// Known answers of the Random123 distribution, file kat_vectors, philox4x32 with 10 rounds.
TEST(Rng, PhiloxGivesThePublishedBlocks) {
  EXPECT_EQ(Philox4x32({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(Philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, AStreamDoesNotDependOnOtherStreams) {
  Rng alone(7, "scene/a");
  const double first = alone.Uniform();
  Rng other(7, "scene/b");
  other.Uniform();
  Rng again(7, "scene/a");
  EXPECT_EQ(again.Uniform(), first);
  EXPECT_NE(Rng(7, "scene/b").Uniform(), first);
  EXPECT_NE(Rng(8, "scene/a").Uniform(), first);
}

TEST(Rng, UniformAndNormalHaveTheirMoments) {
  Rng rng(1, "moments");
  constexpr int kDraws = 200000;
  double uniform_sum = 0;
  double normal_sum = 0;
  double normal_squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = rng.Uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    uniform_sum += u;
    const double n = rng.Normal();
    normal_sum += n;
    normal_squares += n * n;
  }
  // five standard errors of the mean
  EXPECT_NEAR(uniform_sum / kDraws, 0.5, 5 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(normal_sum / kDraws, 0.0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(normal_squares / kDraws, 1.0, 5 * std::sqrt(2.0 / kDraws));
}

TEST(Rng, IndexReachesEveryValueAndNoOther) {
  Rng rng(3, "index");
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 500; ++i) seen.insert(rng.Index(7));
  EXPECT_EQ(seen, (std::set<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/success_statistics.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

EvaluatedEpisode Row(EpisodeOutcome outcome, double peak_deg, std::uint64_t seed = 0,
                     Category category = Category::kInterior) {
  EvaluatedEpisode row;
  row.outcome = outcome;
  row.peak_hinge_rad = peak_deg * kDegree;
  row.seed = seed;
  row.category = category;
  return row;
}

// The interval's ends are the proportions p at which the score test just rejects: they solve
// (rate - p)^2 = z^2 p (1 - p) / n.
TEST(SuccessStatistics, WilsonEndsSolveTheScoreEquation) {
  for (const int episodes : {1, 7, 60, 1000}) {
    for (const int successes : {1, episodes / 2, episodes - 1}) {
      if (successes <= 0 || successes >= episodes) continue;
      const SuccessRate rate = WilsonRate(successes, episodes);
      for (const double p : {rate.low, rate.high}) {
        const double z2 = std::pow(rate.rate - p, 2) * episodes / (p * (1 - p));
        EXPECT_NEAR(z2, 1.959963984540054 * 1.959963984540054, 1e-9);
      }
      EXPECT_LT(rate.low, rate.rate);
      EXPECT_GT(rate.high, rate.rate);
    }
  }
}

// Closed form at the ends: n/(n + z^2) and z^2/(n + z^2).
TEST(SuccessStatistics, AllOrNoneGiveTheClosedForm) {
  const double z2 = 1.959963984540054 * 1.959963984540054;
  const SuccessRate all = WilsonRate(20, 20);
  EXPECT_NEAR(all.low, 20 / (20 + z2), 1e-12);
  EXPECT_EQ(all.high, 1);
  const SuccessRate none = WilsonRate(0, 20);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, z2 / (20 + z2), 1e-12);
}

// Newcombe (1998), table I, method 3: 81 of 263 and 15 of 148.
TEST(SuccessStatistics, WilsonGivesPublishedValues) {
  EXPECT_NEAR(WilsonRate(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(WilsonRate(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(WilsonRate(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(WilsonRate(15, 148).high, 0.1605, 5e-5);
}

TEST(SuccessStatistics, NoEpisodesSayNothing) {
  const SuccessRate rate = WilsonRate(0, 0);
  EXPECT_EQ(rate.low, 0);
  EXPECT_EQ(rate.high, 1);
  EXPECT_THROW(WilsonRate(3, 2), Error);
  EXPECT_THROW(WilsonRate(-1, 2), Error);
  EXPECT_EQ(Summarise({}).over_seeds.rates.size(), 0U);
}

TEST(SuccessStatistics, OutcomesAddUpToTheEpisodes) {
  const std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50), Row(EpisodeOutcome::kGripLost, 20),
      Row(EpisodeOutcome::kGripLost, 31), Row(EpisodeOutcome::kDoorStuck, 4)};
  const SuccessSummary summary = Summarise(rows);
  EXPECT_EQ(summary.opened.successes, 1);
  EXPECT_EQ(summary.opened.episodes, 4);
  EXPECT_EQ(summary.outcomes[static_cast<int>(EpisodeOutcome::kGripLost)], 2);
  int sum = 0;
  for (const int count : summary.outcomes) sum += count;
  EXPECT_EQ(sum, 4);
}

TEST(SuccessStatistics, TheAngleCurveCountsPeaksBeyondEachThreshold) {
  const std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50), Row(EpisodeOutcome::kGripLost, 20),
      Row(EpisodeOutcome::kGripLost, 31), Row(EpisodeOutcome::kDoorStuck, 4)};
  const auto curve = Summarise(rows).over_angle;
  ASSERT_EQ(curve.size(), 4U);
  EXPECT_EQ(curve[0].success.successes, 3);  // 0.1 rad is 5.7 degrees
  EXPECT_EQ(curve[1].success.successes, 3);
  EXPECT_EQ(curve[2].success.successes, 2);
  EXPECT_EQ(curve[3].success.successes, 1);
  EXPECT_NEAR(curve[3].angle_rad, 45 * kDegree, 1e-15);
}

TEST(SuccessStatistics, TimeIsOfOpenedEpisodesForceAndHandleOfAll) {
  std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50), Row(EpisodeOutcome::kOpened, 50),
      Row(EpisodeOutcome::kOpened, 50), Row(EpisodeOutcome::kHandleStuck, 0),
      Row(EpisodeOutcome::kGripLost, 20)};
  const double seconds[] = {9, 5, 6, 1, 1};
  const double newtons[] = {80, 90, 70, 10, 400};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].simulated_s = seconds[i];
    rows[i].peak_force_n = newtons[i];
    rows[i].handle_done = rows[i].outcome != EpisodeOutcome::kHandleStuck;
  }
  const SuccessSummary summary = Summarise(rows);
  EXPECT_EQ(summary.median_opening_s, 6);
  EXPECT_EQ(summary.median_force_n, 80);
  EXPECT_EQ(summary.peak_force_n, 400);
  EXPECT_EQ(summary.handle_done.successes, 4);
  EXPECT_EQ(summary.handle_done.episodes, 5);
}

// Rates 1/2, 1, 0: mean 1/2, unbiased variance ((0)^2 + (1/2)^2 + (1/2)^2) / 2 = 1/4.
TEST(SuccessStatistics, SeedsGiveMeanAndUnbiasedVariance) {
  const std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50, 7),   Row(EpisodeOutcome::kNotReached, 0, 7),
      Row(EpisodeOutcome::kOpened, 50, 2),   Row(EpisodeOutcome::kOpened, 60, 2),
      Row(EpisodeOutcome::kDoorStuck, 0, 9), Row(EpisodeOutcome::kDoorStuck, 0, 9)};
  const SeedSpread spread = Summarise(rows).over_seeds;
  EXPECT_EQ(spread.seeds, (std::vector<std::uint64_t>{2, 7, 9}));
  EXPECT_EQ(spread.rates, (std::vector<double>{1, 0.5, 0}));
  EXPECT_NEAR(spread.mean, 0.5, 1e-15);
  EXPECT_NEAR(spread.variance, 0.25, 1e-15);
}

TEST(SuccessStatistics, CausesAreCountedWithWhatWasNeverInViewByItself) {
  std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50),     Row(EpisodeOutcome::kNotReached, 0),
      Row(EpisodeOutcome::kGripLost, 20),   Row(EpisodeOutcome::kNotReached, 0),
      Row(EpisodeOutcome::kHandleStuck, 0), Row(EpisodeOutcome::kGripLost, 10)};
  rows[3].detail = "grasp cost 0.00; no point to take hold of is in view";
  rows[4].detail = rows[3].detail;  // says so of another outcome
  std::string found;
  for (const FailureCause& cause : CausesOf(rows))
    found += cause.name + " " + std::to_string(cause.episodes) + " " + std::to_string(cause.first) +
             "; ";
  EXPECT_EQ(found, "grip_lost 2 2; not_reached 1 1; no_grasp_in_view 1 3; handle_stuck 1 4; ");
  EXPECT_TRUE(CausesOf(std::vector{rows[0]}).empty());
}

TEST(SuccessStatistics, CategoriesPartitionTheEpisodes) {
  const std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50, 0, Category::kStorageFurniture),
      Row(EpisodeOutcome::kOpened, 50, 0, Category::kInterior),
      Row(EpisodeOutcome::kOpened, 50, 1, Category::kStorageFurniture)};
  EXPECT_EQ(CategoriesOf(rows),
            (std::vector<Category>{Category::kInterior, Category::kStorageFurniture}));
  EXPECT_EQ(OfCategory(rows, Category::kStorageFurniture).size(), 2U);
  EXPECT_EQ(OfCategory(rows, Category::kCar).size(), 0U);
}

}  // namespace
}  // namespace doorforge

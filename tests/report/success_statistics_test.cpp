// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/success_statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

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
  for (const double trials : {1.5, 7.0, 60.0, 1000.0}) {
    for (const double successes : {1.0, trials / 2, trials - 1}) {
      const Interval interval = WilsonInterval(successes, trials);
      const double rate = successes / trials;
      for (const double p : {interval.low, interval.high}) {
        const double z2 = std::pow(rate - p, 2) * trials / (p * (1 - p));
        EXPECT_NEAR(z2, 1.959963984540054 * 1.959963984540054, 1e-9);
      }
      EXPECT_LT(interval.low, rate);
      EXPECT_GT(interval.high, rate);
    }
  }
}

// Closed form at the ends: n/(n + z^2) and z^2/(n + z^2).
TEST(SuccessStatistics, AllOrNoneGiveTheClosedForm) {
  const double z2 = 1.959963984540054 * 1.959963984540054;
  EXPECT_NEAR(WilsonInterval(20, 20).low, 20 / (20 + z2), 1e-12);
  EXPECT_EQ(WilsonInterval(20, 20).high, 1);
  EXPECT_EQ(WilsonInterval(0, 20).low, 0);
  EXPECT_NEAR(WilsonInterval(0, 20).high, z2 / (20 + z2), 1e-12);
  EXPECT_THROW(WilsonInterval(3, 2), Error);
  EXPECT_THROW(WilsonInterval(-1, 2), Error);
}

// Newcombe (1998), table I, method 3: 81 of 263 and 15 of 148.
TEST(SuccessStatistics, WilsonGivesPublishedValues) {
  EXPECT_NEAR(WilsonInterval(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(WilsonInterval(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(WilsonInterval(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(WilsonInterval(15, 148).high, 0.1605, 5e-5);
}

// `handles` handles on `bodies` bodies, `seeds` times each.
std::vector<ClusteredTrial> Grid(int bodies, int handles, int seeds,
                                 const std::function<double(int, int)>& success) {
  std::vector<ClusteredTrial> trials;
  for (int b = 0; b < bodies; ++b) {
    for (int h = 0; h < handles; ++h) {
      for (int seed = 0; seed < seeds; ++seed)
        trials.push_back({"body" + std::to_string(b), "handle" + std::to_string(h), success(b, h)});
    }
  }
  return trials;
}

// Where a handle decides all, a resample of `handles` of them has the binomial's variance, so the
// interval is that of as many trials as there are handles.
TEST(ClusteredRate, WhereHandlesDecideTheyAreTheTrials) {
  for (const int handles : {8, 20, 40}) {
    const auto trials =
        Grid(12, handles, 3, [&](int, int h) { return h < handles / 4 ? 0.0 : 1.0; });
    const SuccessRate rate = ClusteredRate(trials);
    EXPECT_DOUBLE_EQ(rate.rate, 0.75);
    EXPECT_EQ(rate.episodes, 12 * handles * 3);
    EXPECT_NEAR(rate.trials, handles, 0.12 * handles);
    const Interval expected = WilsonInterval(0.75 * handles, handles);
    EXPECT_NEAR(rate.low, expected.low, 0.03);
    EXPECT_NEAR(rate.high, expected.high, 0.03);
  }
}

TEST(ClusteredRate, WhereBodiesDecideTheyAreTheTrials) {
  const SuccessRate rate =
      ClusteredRate(Grid(20, 6, 3, [](int b, int) { return b % 4 == 0 ? 0.0 : 1.0; }));
  EXPECT_NEAR(rate.trials, 20, 2.4);
}

// More seeds of the same doors say nothing of other doors.
TEST(ClusteredRate, MoreSeedsDoNotNarrowIt) {
  const auto pattern = [](int b, int h) { return (b * 7 + h * 3) % 5 == 0 ? 0.0 : 1.0; };
  const SuccessRate one = ClusteredRate(Grid(10, 9, 1, pattern));
  const SuccessRate many = ClusteredRate(Grid(10, 9, 9, pattern));
  EXPECT_DOUBLE_EQ(one.low, many.low);
  EXPECT_DOUBLE_EQ(one.high, many.high);
  EXPECT_LE(many.trials, 90);
}

TEST(ClusteredRate, WhereAllSucceedTheDoorsAreCounted) {
  const SuccessRate rate = ClusteredRate(Grid(6, 4, 3, [](int, int) { return 1.0; }));
  EXPECT_EQ(rate.trials, 24);
  EXPECT_EQ(rate.high, 1);
  EXPECT_DOUBLE_EQ(rate.low, WilsonInterval(24, 24).low);
}

// Where handles decide, a resample's mean is that of as many draws of +1, 0 and -1, whose standard
// deviation is known: sqrt((p - m^2) / n) for a share p that differs and the mean m.
TEST(MeanDifference, WhereHandlesDecideTheyAreTheTrials) {
  constexpr int kHandles = 60;
  const auto trials = Grid(12, kHandles, 2,
                           [](int, int h) { return h % 3 == 0 ? 1.0 : (h % 6 == 1 ? -1.0 : 0.0); });
  const ClusteredDifference found = MeanDifference(trials);
  const double mean = 1.0 / 3 - 1.0 / 6;
  const double deviation = std::sqrt((0.5 - mean * mean) / kHandles);
  EXPECT_EQ(found.trials, 12 * kHandles * 2);
  EXPECT_NEAR(found.mean, mean, 1e-12);
  EXPECT_NEAR(found.low, mean - 1.96 * deviation, 0.02);
  EXPECT_NEAR(found.high, mean + 1.96 * deviation, 0.02);
  EXPECT_EQ(found.IsSignificant(), found.low > 0);
}

TEST(MeanDifference, TheOtherWayRoundItIsItsMirrorImage) {
  const auto pattern = [](int b, int h) { return (b * 7 + h * 3) % 5 == 0 ? -1.0 : 0.5; };
  const ClusteredDifference one = MeanDifference(Grid(10, 9, 1, pattern));
  const ClusteredDifference other =
      MeanDifference(Grid(10, 9, 1, [&](int b, int h) { return -pattern(b, h); }));
  EXPECT_NEAR(other.mean, -one.mean, 1e-12);
  // percentiles of a finite number of resamples: the ranks from both ends are the same
  EXPECT_NEAR(other.low, -one.high, 1e-12);
  EXPECT_NEAR(other.high, -one.low, 1e-12);
}

TEST(MeanDifference, EqualsDoNotDifferAndAConstantOneAlwaysDoes) {
  const auto constant = [](double value) {
    return MeanDifference(Grid(4, 5, 2, [value](int, int) { return value; }));
  };
  EXPECT_EQ(constant(0).low, 0);
  EXPECT_EQ(constant(0).high, 0);
  EXPECT_FALSE(constant(0).IsSignificant());
  EXPECT_DOUBLE_EQ(constant(-1).high, -1);
  EXPECT_TRUE(constant(-1).IsSignificant());
  EXPECT_EQ(MeanDifference({}).trials, 0);
}

// How often the interval of a sample covers the rate of the population that it was drawn from:
// handles and bodies of normally distributed difficulty, as a simulation of its own.
TEST(ClusteredRate, CoversTheRateOfThePopulation) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto opens = [&](double handle, double body) {
    return handle + 0.5 * body + 0.5 * normal(random) > -1.2 ? 1.0 : 0.0;
  };
  // the sum is normal of variance 1.5
  const double truth = 0.5 * std::erfc(-1.2 / std::sqrt(1.5) / std::sqrt(2));
  int covered = 0;
  int by_episodes = 0;
  constexpr int kSamples = 300;
  for (int sample = 0; sample < kSamples; ++sample) {
    std::vector<double> handles(14);
    std::vector<double> bodies(14);
    for (double& handle : handles) handle = normal(random);
    for (double& body : bodies) body = normal(random);
    std::vector<ClusteredTrial> trials;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t h = (b + k) % handles.size();
        for (int seed = 0; seed < 3; ++seed)
          trials.push_back(
              {"b" + std::to_string(b), "h" + std::to_string(h), opens(handles[h], bodies[b])});
      }
    }
    const SuccessRate rate = ClusteredRate(trials);
    covered += rate.low <= truth && truth <= rate.high ? 1 : 0;
    const Interval naive = WilsonInterval(rate.successes, rate.episodes);
    by_episodes += naive.low <= truth && truth <= naive.high ? 1 : 0;
  }
  EXPECT_GE(covered, 0.93 * kSamples);
  EXPECT_LE(by_episodes, 0.80 * kSamples) << "or the test could not tell the two apart";
}

TEST(ClusteredRate, TheOrderDoesNotMatter) {
  auto trials = Grid(5, 4, 2, [](int b, int h) { return (b + h) % 3 == 0 ? 0.0 : 1.0; });
  const SuccessRate before = ClusteredRate(trials);
  std::ranges::reverse(trials);
  const SuccessRate after = ClusteredRate(trials);
  EXPECT_EQ(before.low, after.low);
  EXPECT_EQ(before.high, after.high);
}

TEST(SuccessStatistics, NoEpisodesSayNothing) {
  const SuccessRate rate = ClusteredRate({});
  EXPECT_EQ(rate.low, 0);
  EXPECT_EQ(rate.high, 1);
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
    rows[i].handle_turned = rows[i].outcome != EpisodeOutcome::kHandleStuck;
  }
  const SuccessSummary summary = Summarise(rows);
  EXPECT_EQ(summary.median_opening_s, 6);
  EXPECT_EQ(summary.median_force_n, 80);
  EXPECT_EQ(summary.peak_force_n, 400);
  EXPECT_EQ(summary.handle_turned.successes, 4);
  EXPECT_EQ(summary.handle_turned.episodes, 5);
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

TEST(SuccessStatistics, DoorsWithAndWithoutALatchAreToldApartWhereACategoryHasBoth) {
  std::vector<EvaluatedEpisode> rows = {
      Row(EpisodeOutcome::kOpened, 50, 0, Category::kStorageFurniture),
      Row(EpisodeOutcome::kGripLost, 5, 0, Category::kStorageFurniture),
      Row(EpisodeOutcome::kOpened, 50, 0, Category::kStorageFurniture),
      Row(EpisodeOutcome::kOpened, 50, 1, Category::kInterior)};
  rows[2].mechanism = Mechanism::kNone;
  std::string names;
  for (const EpisodeGroup& group : GroupsOf(rows)) {
    names += NameOf(group) + " ";
    names += std::to_string(Summarise(OfGroup(rows, group)).opened.successes) + "/" +
             std::to_string(OfGroup(rows, group).size()) + "; ";
  }
  EXPECT_EQ(names,
            "overall 3/4; interior 1/1; storagefurniture 2/3; storagefurniture/latched 1/2; "
            "storagefurniture/unlatched 1/1; ");
}

}  // namespace
}  // namespace doorforge

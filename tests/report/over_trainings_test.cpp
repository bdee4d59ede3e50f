// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/over_trainings.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

#include "example_report.h"

namespace doorforge {
namespace {

EvaluationReport WithOpened(std::size_t count) {
  EvaluationReport report = ExampleReport();
  for (std::size_t i = 0; i < report.episodes.size(); ++i)
    report.episodes[i].outcome = i < count ? EpisodeOutcome::kOpened : EpisodeOutcome::kGripLost;
  return report;
}

// 18 episodes, 12 of interior doors and then 6 of storage furniture: 9, 12 and 18 opened.
TEST(OverTrainings, GiveMeanAndUnbiasedDeviation) {
  const std::vector<EvaluationReport> reports = {WithOpened(9), WithOpened(12), WithOpened(18)};
  const TrainingsSummary summary = SummariseTrainings(reports);
  ASSERT_EQ(summary.trainings, 3U);
  const GroupOverTrainings& all = summary.groups.at(0);
  EXPECT_NEAR(all.opened.mean, 13.0 / 18, 1e-12);
  EXPECT_NEAR(all.opened.deviation, std::sqrt((16.0 + 1 + 25) / 2) / 18, 1e-12);
  EXPECT_NEAR(all.rate.rate, all.opened.mean, 1e-12);
  EXPECT_LT(all.rate.low, all.opened.mean);
  EXPECT_GT(all.rate.high, all.opened.mean);
  // interior 9/12, 1, 1; storage furniture 0, 0, 1
  EXPECT_NEAR(summary.mean_of_categories.rates.at(0), 0.375, 1e-12);
  EXPECT_NEAR(summary.mean_of_categories.mean, (0.375 + 0.5 + 1) / 3, 1e-12);
  const std::string table = TrainingsTable(summary);
  EXPECT_NE(table.find("mean over 3 trainings"), std::string::npos) << table;
  EXPECT_NE(table.find("50.0, 66.7, 100.0"), std::string::npos) << table;
  EXPECT_NEAR(TrainingsToJson(summary)["success"]["overall"]["mean"], 13.0 / 18, 1e-12);
}

TEST(OverTrainings, OneTrainingHasTheIntervalOfItsReport) {
  const std::vector<EvaluationReport> reports = {WithOpened(9)};
  const GroupOverTrainings all = SummariseTrainings(reports).groups.at(0);
  const SuccessRate rate = Summarise(reports[0].episodes).opened;
  EXPECT_EQ(all.rate.low, rate.low);
  EXPECT_EQ(all.rate.high, rate.high);
  EXPECT_EQ(all.opened.deviation, 0);
}

TEST(OverTrainings, ReportsOfOtherEpisodesAreRefused) {
  std::vector<EvaluationReport> reports = {WithOpened(9), WithOpened(9)};
  reports[1].episodes[4].seed += 1;
  EXPECT_THROW(SummariseTrainings(reports), Error);
  reports[1] = WithOpened(9);
  reports[1].doors.pop_back();
  EXPECT_THROW(SummariseTrainings(reports), Error);
  EXPECT_THROW(SummariseTrainings({}), Error);
}

}  // namespace
}  // namespace doorforge

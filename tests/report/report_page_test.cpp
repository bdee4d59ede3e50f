// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/report_page.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/program.h"
#include "doorforge/report/report_table.h"

#include "example_pictures.h"
#include "example_report.h"

namespace doorforge {
namespace {

int Check(const std::string& page, int pictures) {
  // tests run side by side
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::filesystem::path path =
      std::filesystem::path(DOORFORGE_BINARY_DIR) / ("report_page_" + test + ".html");
  CommitFile(path, page);
  return RunChild({PYTHON, DOORFORGE_SOURCE_DIR "/tests/report/page_check.py", path.string(),
                   std::to_string(pictures)});
}

TEST(ReportPage, IsWellFormedSelfContainedAndHoldsItsPictures) {
  const EvaluationReport report = ExampleReport();
  EXPECT_EQ(Check(ReportPage(report, ExamplePictures(report)), PictureCount(report)), 0);
}

TEST(ReportPage, ReadsWithoutPicturesReferenceOrFailures) {
  EvaluationReport report = ExampleReport();
  EXPECT_EQ(Check(ReportPage(report, {}), 0), 0);
  report.provenance.policy = "expert";
  report.reference.clear();
  report.training_doors.clear();
  report.trained_on = {};
  report.losses.clear();
  for (EvaluatedEpisode& episode : report.episodes) episode.outcome = EpisodeOutcome::kOpened;
  const std::string page = ReportPage(report, {});
  EXPECT_EQ(Check(page, 0), 0);
  EXPECT_NE(page.find("No episode failed."), std::string::npos);
}

TEST(ReportPage, ShowsTheHeadlineAndEveryCause) {
  const EvaluationReport report = ExampleReport();
  const std::string page = ReportPage(report, {});
  const SuccessSummary summary = Summarise(report.episodes);
  const std::string rate = std::to_string(static_cast<int>(std::lround(100 * summary.opened.rate)));
  EXPECT_NE(page.find("<b>" + rate + "\u00a0%</b>"), std::string::npos);
  for (int i = 1; i < kEpisodeOutcomeCount; ++i) {
    const auto name = std::string(NameOf(static_cast<EpisodeOutcome>(i)));
    const bool occurs = summary.outcomes[static_cast<std::size_t>(i)] > 0;
    EXPECT_EQ(page.find("data-outcome=\"" + name + '"') != std::string::npos, occurs) << name;
  }
}

// A baseline of the toolkit is no trained policy, whatever stage it plays.
TEST(ReportPage, APolicyOfTheToolkitIsCalledByItsName) {
  EvaluationReport report = ExampleReport();
  report.provenance.policy = "expert";
  report.provenance.policy_sha256.clear();
  report.provenance.handler_sha256 = "wiggle";
  report.provenance.grasper_sha256 = "nearest";
  const std::string page = ReportPage(report, {});
  EXPECT_NE(page.find("The policy nearest chooses the grasp"), std::string::npos);
  EXPECT_NE(page.find("the policy wiggle turns it"), std::string::npos);
  EXPECT_EQ(page.find("trained policy"), std::string::npos);
  const std::string table = ReportTable(report);
  EXPECT_NE(table.find("grasp: nearest; handle: wiggle; opening: expert"), std::string::npos)
      << table;
}

// Who does all of it says nothing of stages.
TEST(ReportPage, OnePolicyOfTheWholeEpisodeIsOne) {
  EvaluationReport report = ExampleReport();
  report.provenance.policy_sha256 = std::string(64, 'a');
  report.provenance.handler_sha256 = report.provenance.policy_sha256;
  EXPECT_TRUE(IsSwitchPredicted(report.provenance));  // another one took hold
  report.provenance.grasper_sha256 = report.provenance.policy_sha256;
  EXPECT_FALSE(IsSwitchPredicted(report.provenance));
  EXPECT_NE(ReportPage(report, {}).find("One trained policy takes hold of the handle"),
            std::string::npos);
  EXPECT_NE(ReportTable(report).find("\ngrasp, handle and opening: trained aaaaaaaaaaaa\n"),
            std::string::npos);
}

TEST(ReportPage, SaysWhatAPolicyIsToldBeyondARobot) {
  EvaluationReport report = ExampleReport();
  EXPECT_EQ(ReportPage(report, {}).find("privileges"), std::string::npos);
  EXPECT_EQ(ReportTable(report).find("privileges"), std::string::npos);
  report.provenance.privileges = {"knows <this>", "and that"};
  EXPECT_NE(ReportPage(report, {}).find("<dt>privileges</dt><dd>knows &lt;this&gt;; and that</dd>"),
            std::string::npos);
  EXPECT_NE(ReportTable(report).find("privileges: knows <this>; and that\n"), std::string::npos);
}

TEST(ReportPage, ADoorWhoseHandleWasNeverInViewHasACauseWithoutAFilm) {
  EvaluationReport report = ExampleReport();
  for (EvaluatedEpisode& episode : report.episodes) {
    episode.outcome = EpisodeOutcome::kNotReached;
    episode.detail = "grasp cost 0.00; no point to take hold of is in view";
  }
  const std::string page = ReportPage(report, ExamplePictures(report));
  EXPECT_NE(page.find("<h3>No grasp in view</h3>"), std::string::npos);
  EXPECT_NE(page.find("<option value=\"no_grasp_in_view\">"), std::string::npos);
  EXPECT_EQ(page.find("<h3>Not reached</h3>"), std::string::npos);
  EXPECT_EQ(ReportToJson(report)["causes"].dump(),
            "{\"no_grasp_in_view\":" + std::to_string(report.episodes.size()) + "}");
}

TEST(ReportPage, TextFromOutsideIsEscaped) {
  EvaluationReport report = ExampleReport();
  report.doors[0].body.id = "<script>alert(1)</script>";
  report.losses[0].name = "<script>alert(2)</script>";
  report.episodes[0].detail = "\"/><img src=x onerror=alert(1)>";
  report.provenance.command = "eval --out '</pre><b>'";
  const std::string page = ReportPage(report, {});
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  EXPECT_EQ(Check(page, 0), 0);
}

TEST(ReportPage, SameReportGivesTheSameBytes) {
  const EvaluationReport report = ExampleReport();
  EXPECT_EQ(ReportPage(report, ExamplePictures(report)),
            ReportPage(ReportFromJson(ReportToJson(report), "report"), ExamplePictures(report)));
}

}  // namespace
}  // namespace doorforge

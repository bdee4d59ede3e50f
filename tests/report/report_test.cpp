// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/report.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/report/html_numbers.h"
#include "doorforge/report/report_folder.h"

#include "example_report.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

TEST(Report, ReadsBackWhatItWrote) {
  const auto json = ReportToJson(ExampleReport());
  const EvaluationReport again =
      ReportFromJson(nlohmann::ordered_json::parse(json.dump()), "report");
  EXPECT_EQ(ReportToJson(again).dump(), json.dump());
  EXPECT_EQ(again.episodes.size(), ExampleReport().episodes.size());
  EXPECT_TRUE(std::isnan(again.losses.front().validation.front()));
}

TEST(Report, KeepsWhatAPolicyIsToldBeyondARobot) {
  EvaluationReport report = ExampleReport();
  EXPECT_FALSE(ReportToJson(report).at("provenance").contains("privileges"));
  EXPECT_FALSE(ReportToJson(report).at("provenance").contains("finder_sha256"));
  report.provenance.finder_sha256 = std::string(64, 'f');
  report.provenance.privileges = {"knows <this>", "and that"};
  const auto json = ReportToJson(report);
  EXPECT_EQ(ReportFromJson(json, "report").provenance.privileges, report.provenance.privileges);
  EXPECT_EQ(ReportFromJson(json, "report").provenance.finder_sha256, std::string(64, 'f'));
  auto bad = json;
  bad["provenance"]["privileges"] = {"text", 3};
  EXPECT_THROW(ReportFromJson(bad, "report"), Error);
}

TEST(Report, SuccessInTheFileIsCountedFromItsRows) {
  const auto json = ReportToJson(ExampleReport());
  int opened = 0;
  int interior = 0;
  for (const auto& row : json.at("episodes")) {
    opened += row.at("outcome") == "opened" ? 1 : 0;
    interior += row.at("category") == "interior" ? 1 : 0;
  }
  const auto& overall = json.at("success").at("overall");
  EXPECT_EQ(overall.at("episodes"), json.at("episodes").size());
  EXPECT_NEAR(overall.at("rate").get<double>(),
              static_cast<double>(opened) / static_cast<double>(json.at("episodes").size()), 1e-15);
  EXPECT_EQ(json.at("success").at("interior").at("episodes"), interior);
  EXPECT_FALSE(json.at("success").contains("car")) << "categories without episodes are left out";
  int failures = 0;
  for (const auto& [cause, count] : json.at("causes").items()) failures += count.get<int>();
  EXPECT_EQ(failures + opened, static_cast<int>(json.at("episodes").size()));
}

TEST(Report, NeverRoundsToAllOrNothing) {
  const std::string space = "\u00a0";
  EXPECT_EQ(internal::Percent(1), "100" + space + "%");
  EXPECT_EQ(internal::Percent(917.0 / 921), "99.6" + space + "%");
  EXPECT_EQ(internal::Percent(99999.0 / 100000), "99.9" + space + "%");
  EXPECT_EQ(internal::Percent(0.943), "94" + space + "%");
  EXPECT_EQ(internal::Percent(1e-5), "0.1" + space + "%");
  EXPECT_EQ(internal::Percent(0), "0" + space + "%");
}

TEST(Report, ADoorIsSeenWhenItsBodyOrItsHandleWasTrainedOn) {
  EvaluationReport report = ExampleReport();
  EXPECT_TRUE(SeenDoors(report.doors, report.trained_on).empty());
  report.doors[1].handle.id = report.trained_on.handles[3].id;
  report.doors[4].body.sha256 = report.trained_on.bodies[0].sha256;  // the same under another id
  report.trained_on.handles[2].shape = ShapeDescriptor(13, 0.3);
  report.doors[5].handle.shape = ShapeDescriptor(13, 0.3001);  // the same at another size
  EXPECT_EQ(SeenDoors(report.doors, report.trained_on),
            (std::vector<std::string>{report.doors[1].id, report.doors[4].id, report.doors[5].id}));
}

TEST(Report, RefusesWhatIsNotAReport) {
  const auto good = ReportToJson(ExampleReport());
  const auto refused = [&](auto&& change) {
    auto bad = good;
    change(bad);
    EXPECT_THROW(ReportFromJson(bad, "report"), Error);
  };
  refused([](auto& json) { json["schema_version"] = 99; });
  refused([](auto& json) { json["episodes"] = 3; });
  refused([](auto& json) { json["episodes"][0]["outcome"] = "teleported"; });
  refused([](auto& json) { json["losses"][0]["train"].erase(0); });
  refused([](auto& json) { json.erase("doors"); });
}

TEST(Report, IsReadFromItsFolderOrByItsFile) {
  const fs::path folder = fs::temp_directory_path() / ("report_test_" + std::to_string(::getpid()));
  {
    StagedFolder staged(folder, kReportFolder, Existing::kReplace);
    WriteReportFolder(ExampleReport(), {}, staged);
  }
  const std::string written = ReportToJson(ExampleReport()).dump();
  EXPECT_EQ(ReportToJson(ReadReport(folder)).dump(), written);
  EXPECT_EQ(ReportToJson(ReadReport(folder / "report.json")).dump(), written);
  fs::remove_all(folder);
  EXPECT_THROW(ReadReport(folder), Error);
}

}  // namespace
}  // namespace doorforge

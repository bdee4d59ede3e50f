// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/benchmark/benchmark_page.h"
#include "doorforge/benchmark/benchmark_pipeline.h"
#include "doorforge/benchmark/benchmark_result.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/pipeline/join_pipelines.h"
#include "doorforge/report/report.h"

#include "../report/example_report.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const PipelineStep& StepNamed(const Pipeline& pipeline, const std::string& name) {
  return *std::ranges::find(pipeline.steps, name, &PipelineStep::name);
}

std::set<std::string> Actors(const Pipeline& pipeline, const std::string& evaluation) {
  const auto names = PlaceholdersOf(StepNamed(pipeline, evaluation).command);
  return {names.begin(), names.end()};
}

std::string MessageOf(const std::function<void()>& wrong) {
  try {
    wrong();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BenchmarkTable, EveryRowHasSixFiguresOfThePaperOrNoneAndEverySizeItsRows) {
  EXPECT_EQ(BenchmarkSizes(),
            (std::vector<std::string>{"paper", "quick", "robustness", "simulators"}));
  const std::map<std::string, std::string> last = {{"robustness", "plain"},
                                                   {"simulators", "bullet"}};
  for (const std::string& size : BenchmarkSizes()) {
    const Benchmark benchmark = ReadBenchmark(size, {}, {});
    EXPECT_NE(SizesText().find(" " + benchmark.size.about + "\n"), std::string::npos) << size;
    // what the others are compared with
    EXPECT_EQ(benchmark.rows.back().name, last.contains(size) ? last.at(size) : "ours");
    for (const BenchmarkRow& row : benchmark.rows)
      EXPECT_TRUE(row.paper.empty() || row.paper.size() == std::size(kCategories)) << row.name;
  }
}

TEST(BenchmarkTable, AnUnknownRowIsToldWithTheNearest) {
  const std::string told = MessageOf([] { ReadBenchmark("quick", {}, {"gaparnet"}); });
  EXPECT_NE(told.find("did you mean \"gapartnet\"?"), std::string::npos) << told;
  EXPECT_NE(MessageOf([] { ReadBenchmark("quik", {}, {}); }).find("\"quick\""), std::string::npos);
  EXPECT_NE(MessageOf([] { ReadBenchmark("quick", {"doors=0"}, {}); }), "");
}

TEST(BenchmarkTable, ARowOfOnesOwnIsJudgedAmongTheOthers) {
  const fs::path file =
      fs::temp_directory_path() / ("benchmark_own_" + std::to_string(::getpid()) + ".yaml");
  CommitFile(
      file,
      "rows: [mine, expert]\n"
      "own:\n  - {name: mine, title: My own, evaluate: [--opener, 'ws://localhost:8123']}\n");
  const Benchmark benchmark = ReadBenchmark(file.string(), {}, {});
  fs::remove(file);
  const Pipeline joined = PlanBenchmark(benchmark).pipeline;
  const auto& command = StepNamed(joined, "mine_1_test").command;
  EXPECT_EQ(std::ranges::count(command, "ws://localhost:8123"), 1);
}

TEST(BenchmarkPipeline, WhatRowsHaveInCommonIsMadeOnce) {
  const Benchmark benchmark =
      ReadBenchmark("quick", {"trainings=1"}, {"without_condition", "without_state", "ours"});
  const Pipeline joined = PlanBenchmark(benchmark).pipeline;
  std::set<std::string> commands;
  for (const PipelineStep& step : joined.steps) {
    std::string line;
    for (const std::string& argument : step.command) line += argument + " ";
    EXPECT_TRUE(commands.insert(line).second) << line;
    // each needs what comes before it
    for (const std::string& need : step.needs)
      EXPECT_LT(&StepNamed(joined, need), &step) << step.name;
  }
  const auto condition = Actors(joined, "without_condition_1_test");
  const auto state = Actors(joined, "without_state_1_test");
  const auto ours = Actors(joined, "ours_1_test");
  // the opener does not depend on what comes before it; the handler's data do on the opener
  EXPECT_TRUE(condition.contains("opener"));
  EXPECT_TRUE(ours.contains("opener"));
  EXPECT_FALSE(state.contains("opener"));
  for (const char* actor : {"handler", "grasper"})
    EXPECT_EQ(condition.contains(actor) + state.contains(actor) + ours.contains(actor), 1) << actor;
  EXPECT_EQ(std::ranges::count(joined.steps, "open_data", &PipelineStep::name), 1);
}

TEST(BenchmarkPipeline, EveryTrainingHasASeedOfItsOwnAndTheSameDoors) {
  const BenchmarkPlan plan = PlanBenchmark(
      ReadBenchmark("quick", {"trainings=3", "doors=5", "seeds=2"}, {"gapartnet", "ours"}));
  EXPECT_EQ(plan.parts.size(), 2U + 3 * 2);
  std::set<std::string> openers;
  for (const BenchmarkPart& part : plan.parts) {
    const PipelineStep& step =
        *std::ranges::find(plan.pipeline.steps, part.report, &PipelineStep::output);
    const auto has = [&](const std::string& option, const std::string& value) {
      const auto at = std::ranges::find(step.command, option);
      return at != step.command.end() && *(at + 1) == value;
    };
    EXPECT_TRUE(has("-n", "5") && has("--seeds", "2") && has("--doors", "{doors}")) << step.name;
    openers.insert(*(std::ranges::find(step.command, "--opener") + 1));
  }
  EXPECT_EQ(openers.size(), 4U);
  EXPECT_EQ(plan.parts.front().train_seconds < plan.parts.back().train_seconds, true);
}

TEST(BenchmarkPipeline, APipelineIsToldTheSettingsThatItHas) {
  const Pipeline joined =
      PlanBenchmark(ReadBenchmark("quick", {"settings=[decisions=4096, open_episodes=9]"},
                                  {"doorgym", "ours_given_grasp"}))
          .pipeline;
  const auto says = [&](const std::string& step, const std::string& option) {
    const auto& command = StepNamed(joined, step).command;
    return *(std::ranges::find(command, option) + 1);
  };
  EXPECT_EQ(says("hand", "--decisions"), "4096");
  EXPECT_EQ(says("open_data", "--episodes"), "9");
  EXPECT_EQ(Actors(joined, "doorgym_1_test").contains("hand"), true);
  EXPECT_EQ(std::ranges::count(joined.steps, "compose",
                               [](const PipelineStep& step) { return step.command.front(); }),
            3);  // doors of both rows, and those of small and large handles
  const std::string told = MessageOf(
      [] { PlanBenchmark(ReadBenchmark("quick", {"settings=[decison=4096]"}, {"doorgym"})); });
  EXPECT_NE(told.find("decisions"), std::string::npos) << told;
}

TEST(BenchmarkPipeline, TheHandOfTrueStatesTeachesTheOneThatLooks) {
  const Pipeline joined =
      PlanBenchmark(ReadBenchmark("quick", {}, {"partmanip", "doorgym"})).pipeline;
  const auto learns = [](const PipelineStep& step) { return step.command.front() == "reinforce"; };
  EXPECT_EQ(std::ranges::count_if(joined.steps, learns), 2);  // one hand for both rows
  EXPECT_TRUE(Actors(joined, "doorgym_1_test").contains("hand"));
  EXPECT_TRUE(Actors(joined, "partmanip_1_test").contains("looks"));
  EXPECT_EQ(StepNamed(joined, "looks").needs, (std::vector<std::string>{"doors", "hand"}));
}

TEST(BenchmarkPipeline, FrozenFeaturesAreThoseOfTheHandThatLooks) {
  const Pipeline joined =
      PlanBenchmark(ReadBenchmark("quick", {"settings=[feature_decisions=4096]"},
                                  {"partmanip", "frozen_features"}))
          .pipeline;
  const auto learns = [](const PipelineStep& step) { return step.command.front() == "reinforce"; };
  EXPECT_EQ(std::ranges::count_if(joined.steps, learns), 3);  // hand and looks are made once
  EXPECT_TRUE(Actors(joined, "frozen_features_1_test").contains("tries"));
  const PipelineStep& tries = StepNamed(joined, "tries");
  EXPECT_EQ(tries.needs, (std::vector<std::string>{"doors", "looks"}));
  EXPECT_NE(std::ranges::find(tries.command, "4096"), tries.command.end());
  EXPECT_NE(std::ranges::find(StepNamed(joined, "hand").command, "1000000"),
            StepNamed(joined, "hand").command.end());
}

TEST(BenchmarkPipeline, WhoSaysTrajectoriesIsTrainedAndDoesAllOfIt) {
  const Pipeline joined =
      PlanBenchmark(ReadBenchmark("quick", {"settings=[trials=9]"}, {"vatmart"})).pipeline;
  const auto& command = StepNamed(joined, "replayer").command;
  EXPECT_NE(std::ranges::find(command, "learning.episodes=9"), command.end());
  EXPECT_NE(std::ranges::find(command, "--trajectories"), command.end());
  EXPECT_TRUE(Actors(joined, "vatmart_1_test").contains("replayer"));
}

TEST(BenchmarkPipeline, WhoseRowsAreNotTrainedMakesDoorsAlone) {
  const Pipeline joined = PlanBenchmark(ReadBenchmark("quick", {}, {"expert"})).pipeline;
  std::vector<std::string> names;
  for (const PipelineStep& step : joined.steps) names.push_back(step.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"parts", "doors", "expert_1_test", "expert_1_unseen"}));
}

TEST(BenchmarkPipeline, ARowMayComposeDoorsOfItsOwn) {
  const Pipeline joined = PlanBenchmark(ReadBenchmark("robustness", {"evaluate=[--opener, expert]"},
                                                      {"right", "plain"}))
                              .pipeline;
  const auto& composed = StepNamed(joined, "doors_right");
  EXPECT_EQ(composed.command.back(), "hinge_side=right");
  EXPECT_EQ(composed.output, "made/doors_right");
  EXPECT_EQ(StepNamed(joined, "doors").output, "made/doors");
  EXPECT_EQ(std::ranges::count(StepNamed(joined, "doors").command, "hinge_side=right"), 0);
  EXPECT_EQ(Actors(joined, "right_1_test").count("doors_right"), 1U);
  EXPECT_EQ(Actors(joined, "plain_1_test").count("doors"), 1U);
  const auto& command = StepNamed(joined, "right_1_unseen").command;
  EXPECT_EQ(std::ranges::count(command, "expert"), 1);
}

TEST(BenchmarkPipeline, GivenDoorsAreRefusedByARowThatComposes) {
  const auto give = [](const std::vector<std::string>& rows) {
    const Benchmark benchmark = ReadBenchmark("robustness", {}, rows);
    BenchmarkPlan plan = PlanBenchmark(benchmark);
    GiveDoors(benchmark, {"mine"}, plan);
    EXPECT_EQ(StepNamed(plan.pipeline, "doors").given, std::vector<std::string>{"mine"});
  };
  EXPECT_NE(MessageOf([&] {
              give({"right", "plain"});
            }).find("row right composes"),
            std::string::npos);
  EXPECT_EQ(MessageOf([&] { give({"strong", "plain"}); }), "");
}

TEST(BenchmarkPipeline, DoorsOfARowsOwnAreNotTrainedOn) {
  const fs::path file =
      fs::temp_directory_path() / ("benchmark_bolt_" + std::to_string(::getpid()) + ".yaml");
  CommitFile(
      file,
      "rows: [bolted, ours]\n"
      "own:\n  - {name: bolted, title: Bolted, pipeline: quick, compose: [--set, latch=bolt], "
      "evaluate: [--opener, '{opener}']}\n");
  const Benchmark benchmark = ReadBenchmark(file.string(), {}, {});
  fs::remove(file);
  const Pipeline joined = PlanBenchmark(benchmark).pipeline;
  EXPECT_EQ(std::ranges::count(joined.steps, "open_data", &PipelineStep::name), 1);
  EXPECT_EQ(Actors(joined, "open_data").count("doors"), 1U);
  EXPECT_EQ(Actors(joined, "bolted_1_test").count("doors_bolted"), 1U);
}

class BenchmarkResultTest : public testing::Test {
 protected:
  BenchmarkResultTest()
      : folder_(fs::temp_directory_path() / ("benchmark_test_" + std::to_string(::getpid()))),
        benchmark_(ReadBenchmark("quick", {}, {"expert", "gapartnet", "ours"})),
        plan_(PlanBenchmark(benchmark_)) {}
  ~BenchmarkResultTest() override { fs::remove_all(folder_); }

  // The row opens all doors of a category, or none.
  void Write(std::size_t row, const std::set<Category>& opened) {
    for (const BenchmarkPart& part : plan_.parts) {
      if (part.row != row) continue;
      EvaluationReport report = ExampleReport();
      const bool unseen = part.report.ends_with("unseen");
      std::erase_if(report.episodes, [&](const EvaluatedEpisode& episode) {
        return (episode.category == Category::kStorageFurniture) != unseen;
      });
      std::erase_if(report.doors, [&](const DoorIdentity& door) {
        return (door.category == Category::kStorageFurniture) != unseen;
      });
      report.reference.clear();
      for (EvaluatedEpisode& episode : report.episodes) {
        const bool opens = opened.contains(episode.category);
        episode.outcome = opens ? EpisodeOutcome::kOpened : EpisodeOutcome::kGripLost;
        episode.peak_hinge_rad = opens ? 0.9 : 0.2;  // 51.6 and 11.5 degrees
      }
      fs::create_directories(folder_ / part.report);
      WriteJsonFile(folder_ / part.report / "report.json", ReportToJson(report));
    }
  }

  fs::path folder_;
  Benchmark benchmark_;
  BenchmarkPlan plan_;
};

TEST_F(BenchmarkResultTest, TableComparisonAndPageSayTheSame) {
  Write(0, {Category::kInterior, Category::kStorageFurniture});
  Write(1, {Category::kInterior});
  Write(2, {Category::kInterior, Category::kStorageFurniture});
  const BenchmarkResult result = ReadBenchmarkResult(benchmark_, plan_, folder_);
  EXPECT_DOUBLE_EQ(result.rows[1].summary.mean_of_categories.mean, 0.5);
  EXPECT_DOUBLE_EQ(result.rows[2].summary.mean_of_categories.mean, 1);
  EXPECT_DOUBLE_EQ(result.comparisons[0].difference.mean, 0);
  EXPECT_FALSE(result.comparisons[0].difference.IsSignificant());
  EXPECT_NEAR(result.comparisons[1].difference.mean, 2.0 / 6, 1e-12);  // 2 of the 6 doors
  const auto json = BenchmarkToJson(result);
  EXPECT_EQ(json["rows"][1]["success"]["success"]["storagefurniture"]["mean"], 0.0);
  EXPECT_EQ(json["comparisons"][1]["with"], "gapartnet");
  // one of two categories opens
  const std::vector<double>& past = result.rows[1].past_degree;
  ASSERT_EQ(past.size(), 91U);
  for (const auto& [degree, share] :
       std::map<std::size_t, double>{{0, 1}, {11, 1}, {12, 0.5}, {51, 0.5}, {52, 0}, {90, 0}})
    EXPECT_DOUBLE_EQ(past[degree], share) << degree;
  EXPECT_EQ(json["rows"][1]["past_degree"].size(), 91U);
  const std::string text = BenchmarkText(result);
  EXPECT_NE(text.find("paper   62"), std::string::npos) << text;
  const std::string page = BenchmarkPage(result);
  EXPECT_NE(page.find("paper&#160;62"), std::string::npos);
  EXPECT_NE(page.find("rows/gapartnet_1_unseen/report.html"), std::string::npos);
  EXPECT_EQ(page, BenchmarkPage(result));
}

TEST_F(BenchmarkResultTest, RowsOfDoorsComposedOtherwiseArePairedByBodyAndHandle) {
  for (const std::size_t row : {0U, 1U, 2U}) Write(row, {Category::kInterior});
  for (const BenchmarkPart& part : plan_.parts) {
    if (part.row != 0) continue;
    const fs::path path = folder_ / part.report / "report.json";
    auto json = ReadJsonFile(path.string());
    auto& episodes = json["episodes"];
    for (auto& episode : episodes)
      episode["door_id"] = episode["door_id"].get<std::string>() + "__right";
    std::reverse(episodes.begin(), episodes.end());
    for (auto& door : json["doors"]) door["id"] = door["id"].get<std::string>() + "__right";
    WriteJsonFile(path, json);
  }
  const BenchmarkResult result = ReadBenchmarkResult(benchmark_, plan_, folder_);
  EXPECT_DOUBLE_EQ(result.comparisons[0].difference.mean, 0);
  EXPECT_DOUBLE_EQ(result.comparisons[0].difference.low, 0);
}

TEST_F(BenchmarkResultTest, RowsOfOtherEpisodesAreRefused) {
  for (const std::size_t row : {0U, 1U, 2U}) Write(row, {});
  const std::string path = (folder_ / plan_.parts[2].report / "report.json").string();
  auto json = ReadJsonFile(path);
  json["episodes"].erase(json["episodes"].begin());
  WriteJsonFile(path, json);
  EXPECT_NE(MessageOf([&] {
              ReadBenchmarkResult(benchmark_, plan_, folder_);
            }).find("not of the same doors"),
            std::string::npos);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/pipeline_run.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// A pipeline whose only step is done already: the user gave what it would have made.
class PipelineRunTest : public testing::Test {
 protected:
  PipelineRunTest()
      : out_(fs::temp_directory_path() / ("pipeline_run_test_" + std::to_string(::getpid()))) {
    fs::create_directories(out_ / "pipeline");
    CommitFile(out_ / "report" / "report.json",
               R"({"success": {"overall": {"rate": 0.5, "low": 0.25, "high": 0.75,)"
               R"( "episodes": 12}}})");
    PipelineStep step;
    step.name = "report";
    step.does = "Success on doors never seen";
    step.output = "report";
    step.records = {"report.json"};
    step.given = {(out_ / "report").string()};
    pipeline_.name = "small";
    pipeline_.steps = {step};
  }
  ~PipelineRunTest() override { fs::remove_all(out_); }

  fs::path out_;
  Pipeline pipeline_;
};

TEST_F(PipelineRunTest, TellsWhoeverListensAndPrintsNothingItself) {
  std::string progress;
  std::string result;
  PipelineRun run{.out = out_};
  run.progress = [&](const std::string& text) { progress += text; };
  run.result = [&](const std::string& text) { result += text; };
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = RunPipeline(pipeline_, run);
  const int unheard = RunPipeline(pipeline_, {.out = out_});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(code, 0);
  EXPECT_EQ(unheard, 0);
  EXPECT_NE(progress.find("== 1/1 report: Success on doors never seen"), std::string::npos);
  EXPECT_NE(result.find("50.0 %   25.0 - 75.0 %   12"), std::string::npos) << result;
}

TEST_F(PipelineRunTest, ThePlanIsATextThatNamesEveryStep) {
  const std::string table = PlanPipeline(pipeline_, {.out = out_});
  EXPECT_NE(table.find("report"), std::string::npos);
  EXPECT_NE(table.find("given"), std::string::npos) << table;
}

TEST(PipelinePresets, EachIsReadAndTheAblationsLeaveOutWhatTheyAreNamedFor) {
  const auto command = [](const std::string& preset, const std::string& step) {
    const Pipeline pipeline = ReadPipeline(preset, {});
    const auto found = std::ranges::find(pipeline.steps, step, &PipelineStep::name);
    std::string line;
    for (const std::string& argument : found->command) line += argument + " ";
    return line;
  };
  for (const std::string& name : PipelinePresets()) EXPECT_NO_THROW(ReadPipeline(name, {})) << name;
  for (const char* step : {"handle_data", "knob_data", "grasp_data", "large_grasp_data"}) {
    EXPECT_NE(command("quick", step).find("{opener}"), std::string::npos) << step;
    EXPECT_EQ(command("without_condition", step).find("{opener}"), std::string::npos) << step;
    EXPECT_NE(command("without_mobile", step).find("base=fixed"), std::string::npos) << step;
  }
  for (const char* step : {"report", "report_given_grasp_unseen", "small_grasp_data"})
    EXPECT_NE(command("without_disentangle", step).find("--opener {handler}"), std::string::npos)
        << step;
  EXPECT_EQ(command("without_disentangle", "handler").find("train motion "), 0U);
  for (const char* step : {"opener", "handler"})
    EXPECT_NE(command("without_state", step).find("state=none"), std::string::npos) << step;
  // of a preset that is like one that is like another
  for (const char* step : {"opener", "handler", "grasper"})
    EXPECT_NE(command("colours", step).find("colors=true"), std::string::npos) << step;
  EXPECT_NE(command("colours", "report_retry").find("appearance=full"), std::string::npos);
}

TEST(PipelinePresets, ThatAreLikeThemselvesAreRefused) {
  const fs::path file =
      fs::temp_directory_path() / ("pipeline_circle_" + std::to_string(::getpid()) + ".yaml");
  CommitFile(file, "schema: doorforge.pipeline\nschema_version: 1\nabout: x\nlike: " +
                       file.string() + "\n");
  EXPECT_THROW(ReadPipeline(file.string(), {}), Error);
  fs::remove(file);
}

TEST(PipelinePresets, AChangeOfAnArgumentThatThereIsNotIsRefused) {
  const fs::path file =
      fs::temp_directory_path() / ("pipeline_change_" + std::to_string(::getpid()) + ".yaml");
  for (const char* change : {"remove: [--opnr]", "replace: {--opnr: --opener}"}) {
    CommitFile(file, std::string("schema: doorforge.pipeline\nschema_version: 1\nabout: x\n"
                                 "like: quick\nsteps:\n  - name: report\n    ") +
                         change + "\n");
    EXPECT_THROW(ReadPipeline(file.string(), {}), Error) << change;
  }
  fs::remove(file);
}

TEST(PipelinePresets, ANameOfItsOwnIsAStepMoreAndNeedsACommand) {
  const Pipeline quick = ReadPipeline("quick", {});
  const fs::path file =
      fs::temp_directory_path() / ("pipeline_step_" + std::to_string(::getpid()) + ".yaml");
  const auto read = [&](const std::string& entry) {
    CommitFile(
        file,
        "schema: doorforge.pipeline\nschema_version: 1\nabout: x\nlike: quick\nsteps:\n" + entry);
    return ReadPipeline(file.string(), {});
  };
  const Pipeline more = read(
      "  - name: again\n    does: Evaluation again\n    needs: [doors, opener]\n"
      "    command: [eval, --opener, \"{opener}\", --doors, \"{doors}\", --out, \"{again}\"]\n"
      "    output: again\n    records: [report.json]\n"
      "    core_seconds: {fixed: 1}\n    mebibytes: {fixed: 1}\n");
  ASSERT_EQ(more.steps.size(), quick.steps.size() + 1);
  EXPECT_EQ(more.steps.back().name, "again");
  EXPECT_EQ(more.steps.back().command.at(2), "{opener}");
  for (std::size_t i = 0; i < quick.steps.size(); ++i)
    EXPECT_EQ(more.steps[i].command, quick.steps[i].command);
  EXPECT_THROW(read("  - name: raport\n    append: [--json]\n"), Error);
  fs::remove(file);
}

TEST(TakePlan, IsTheFirstOfTwoWordsAndNoOther) {
  std::vector<std::string> words = {"plan", "quick"};
  EXPECT_TRUE(TakePlan(words));
  EXPECT_EQ(words, std::vector<std::string>{"quick"});
  EXPECT_FALSE(TakePlan(words));
  EXPECT_EQ(words, std::vector<std::string>{"quick"});
  words = {"quick", "paper"};
  EXPECT_THROW(TakePlan(words), Error);
}

TEST(PresetsText, HasALineForEachPreset) {
  const std::string text = PresetsText();
  for (const std::string& name : PipelinePresets())
    EXPECT_NE(text.find("  " + name + " "), std::string::npos) << text;
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), PipelinePresets().size());
}

}  // namespace
}  // namespace doorforge

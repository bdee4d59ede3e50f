// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/benchmark/benchmark_pipeline.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/pipeline/join_pipelines.h"

namespace doorforge {
namespace {

constexpr const char* kDoorsStep = "doors";
constexpr const char* kData = "data";            // in a row's words: where the shipped policies are
constexpr const char* kDoorsPipeline = "quick";  // who is not trained needs its doors alone

// How many categories a side has, for the forecast alone.
constexpr double kSeenCategories = 4;
constexpr double kUnseenCategories = 2;

// Another step that composes, with the row's arguments; returns its name. What trains a row keeps
// the doors of all.
std::string ComposeAlso(const BenchmarkRow& row, Pipeline& pipeline) {
  PipelineStep step = *std::ranges::find(pipeline.steps, kDoorsStep, &PipelineStep::name);
  const std::string shared = "{" + step.name + "}";
  step.name += "_" + row.name;
  step.output = step.name;
  step.does += ", as row " + row.name + " has them";
  std::ranges::replace(step.command, shared, "{" + step.name + "}");
  step.command.insert(step.command.end(), row.compose.begin(), row.compose.end());
  pipeline.steps.push_back(std::move(step));
  return pipeline.steps.back().name;
}

struct Side {
  const char* name;
  std::string split;
  double categories;
};

/// Joins the rows one by one.
class Planner {
 public:
  explicit Planner(const Benchmark& benchmark)
      : benchmark_(benchmark), joiner_("benchmark " + benchmark.name) {
    for (const std::string& preset : PipelinePresets()) {
      const nlohmann::ordered_json settings = ReadPipeline(preset, {}).settings;
      for (const auto& setting : settings.items()) preset_settings_.insert(setting.key());
    }
  }

  BenchmarkPlan Plan() {
    for (std::size_t row = 0; row < benchmark_.rows.size(); ++row) {
      for (int t = 0; t < benchmark_.TrainingsOf(benchmark_.rows[row]); ++t) AddTraining(row, t);
    }
    BenchmarkPlan plan{joiner_.joined(), std::move(parts_)};
    plan.pipeline.about = benchmark_.size.about;
    plan.pipeline.settings = nlohmann::ordered_json::object();
    return plan;
  }

 private:
  void AddTraining(std::size_t index, int training) {
    const BenchmarkRow& row = benchmark_.rows[index];
    const bool trained = !row.pipeline.empty();
    std::vector<std::string> changes;
    if (trained) {
      changes = SettingsFor(row.pipeline);
      changes.push_back(
          "seed=" + std::to_string(benchmark_.size.seed + static_cast<std::uint64_t>(training)));
    }
    Pipeline pipeline = ReadPipeline(trained ? row.pipeline : kDoorsPipeline, changes);
    const std::string doors =
        row.compose.empty() ? std::string(kDoorsStep) : ComposeAlso(row, pipeline);
    std::vector<std::string> wanted = PlaceholdersOf(WordsOf(row));
    std::erase(wanted, kData);
    wanted.push_back(doors);
    auto names = joiner_.Add(pipeline, wanted, row.name + "_" + std::to_string(training + 1));
    names[kDoorsStep] = names.at(doors);
    for (const Side& side : {Side{"test", benchmark_.size.split, kSeenCategories},
                             Side{"unseen", benchmark_.size.unseen_split, kUnseenCategories}})
      AddEvaluation(index, training, side, names);
  }

  // Those of the size's settings that the pipeline has, and those that no preset has: reading it
  // with them tells the user.
  std::vector<std::string> SettingsFor(const std::string& pipeline) const {
    const nlohmann::ordered_json has = ReadPipeline(pipeline, {}).settings;
    std::vector<std::string> settings;
    for (const std::string& change : benchmark_.size.settings) {
      const std::string key = change.substr(0, change.find('='));
      if (has.contains(key) || !preset_settings_.contains(key)) settings.push_back(change);
    }
    return settings;
  }

  std::vector<std::string> WordsOf(const BenchmarkRow& row) const {
    std::vector<std::string> words = benchmark_.size.evaluate;
    words.insert(words.end(), row.evaluate.begin(), row.evaluate.end());
    return words;
  }

  void AddEvaluation(std::size_t index, int training, const Side& side,
                     const std::map<std::string, std::string>& names) {
    const BenchmarkRow& row = benchmark_.rows[index];
    const BenchmarkSize& size = benchmark_.size;
    PipelineStep step;
    step.name = row.name + "_" + std::to_string(training + 1) + "_" + side.name;
    step.does = row.title + ": " + side.name + " doors";
    step.command = {"eval"};
    std::map<std::string, std::vector<std::string>> values{{kData, {DataFolder().string()}}};
    for (const auto& [name, now] : names) values[name] = {"{" + now + "}"};
    PipelineStep words;
    words.command = WordsOf(row);
    for (const std::string& argument :
         ExpandCommand(words, nlohmann::ordered_json::object(), values))
      step.command.push_back(argument);
    const std::string doors = names.at(kDoorsStep);
    for (const std::string& argument :
         {std::string("--doors"), "{" + doors + "}", "--split=" + side.split, std::string("-n"),
          std::to_string(size.doors), std::string("--seeds"), std::to_string(size.seeds),
          std::string("--set"), std::string("expert_reference=false"), std::string("--out"),
          "{" + step.name + "}", std::string("--threads"), std::string("{threads}")})
      step.command.push_back(argument);
    step.needs = PlaceholdersOf(step.command);
    std::erase_if(step.needs,
                  [&](const std::string& name) { return name == step.name || name == "threads"; });
    step.output = "rows/" + step.name;
    step.records = {"report.json"};
    step.core_seconds = {
        {"fixed", 10 + row.core_seconds * side.categories * size.doors * size.seeds}};
    step.mebibytes = {{"fixed", 5}};
    parts_.push_back({index, training, step.output, SecondsBefore(step)});
    joiner_.Add(std::move(step));
  }

  double SecondsBefore(const PipelineStep& last) const {
    std::set<std::string> needed(last.needs.begin(), last.needs.end());
    double seconds = 0;
    const auto& steps = joiner_.joined().steps;
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
      if (!needed.contains(step->name)) continue;
      needed.insert(step->needs.begin(), step->needs.end());
      seconds += CostOf(step->core_seconds, nlohmann::ordered_json::object());
    }
    return seconds;
  }

  const Benchmark& benchmark_;
  PipelineJoiner joiner_;
  std::set<std::string> preset_settings_;  // keys that some preset's pipeline has
  std::vector<BenchmarkPart> parts_;
};

}  // namespace

BenchmarkPlan PlanBenchmark(const Benchmark& benchmark) { return Planner(benchmark).Plan(); }

void GiveDoors(const Benchmark& benchmark, const std::vector<std::string>& folders,
               BenchmarkPlan& plan) {
  for (const BenchmarkRow& row : benchmark.rows)
    Require(row.compose.empty(), ErrorCode::kInvalidArgument,
            "--doors: row " + row.name +
                " composes doors of its own; leave --doors out, or name other --rows");
  GiveOutput(plan.pipeline, kDoorsStep, folders);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/join_pipelines.h"

#include <algorithm>
#include <set>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr const char* kItself = "{@}";  // stands for a step's own output while it has no name

// Those of `wanted` and all that they need, in the pipeline's order.
std::vector<const PipelineStep*> NeededSteps(const Pipeline& pipeline,
                                             const std::vector<std::string>& wanted) {
  std::set<std::string> needed(wanted.begin(), wanted.end());
  for (const std::string& name : wanted) {
    if (std::ranges::find(pipeline.steps, name, &PipelineStep::name) == pipeline.steps.end())
      throw Error(ErrorCode::kInvalidConfig,
                  "pipeline \"" + pipeline.name + "\": has no step \"" + name + "\"");
  }
  std::vector<const PipelineStep*> steps;
  for (auto step = pipeline.steps.rbegin(); step != pipeline.steps.rend(); ++step) {
    if (!needed.contains(step->name)) continue;
    needed.insert(step->needs.begin(), step->needs.end());
    if (!step->given_with.empty()) needed.insert(step->given_with);
    steps.push_back(&*step);
  }
  std::ranges::reverse(steps);
  return steps;
}

std::string Braced(const std::string& name) { return "{" + name + "}"; }

std::string LineOf(const std::vector<std::string>& command) {
  std::string line;
  for (const std::string& argument : command) line += argument + '\n';
  return line;
}

}  // namespace

std::vector<std::string> PlaceholdersOf(const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const std::string& argument : arguments) {
    for (std::size_t open = argument.find('{'); open != std::string::npos;
         open = argument.find('{', open + 1)) {
      const std::size_t close = argument.find('}', open);
      if (close == std::string::npos) break;
      const std::string name = argument.substr(open + 1, close - open - 1);
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::string PipelineJoiner::NewName(const PipelineStep& step, const std::string& label) const {
  const bool taken =
      std::ranges::find(joined_.steps, step.name, &PipelineStep::name) != joined_.steps.end();
  return taken ? step.name + "_" + label : step.name;
}

std::map<std::string, std::string> PipelineJoiner::Add(const Pipeline& pipeline,
                                                       const std::vector<std::string>& wanted,
                                                       const std::string& label) {
  std::map<std::string, std::string> names;
  for (const PipelineStep* original : NeededSteps(pipeline, wanted)) {
    PipelineStep step = *original;
    std::map<std::string, std::vector<std::string>> values{{step.name, {kItself}}};
    for (std::string& need : step.needs) {
      values[need] = {Braced(names.at(need))};
      need = names.at(need);
    }
    if (!step.given_with.empty()) step.given_with = names.at(step.given_with);
    step.command = ExpandCommand(step, pipeline.settings, values);
    const std::string line = LineOf(step.command);
    if (const auto same = by_command_.find(line); same != by_command_.end()) {
      names[original->name] = same->second;
      continue;
    }
    step.name = NewName(*original, label);
    if (!step.output.empty()) step.output = "made/" + step.name;
    for (std::string& argument : step.command) {
      if (const std::size_t at = argument.find(kItself); at != std::string::npos)
        argument.replace(at, std::string(kItself).size(), Braced(step.name));
    }
    step.core_seconds = {{"fixed", CostOf(step.core_seconds, pipeline.settings)}};
    step.mebibytes = {{"fixed", CostOf(step.mebibytes, pipeline.settings)}};
    by_command_[line] = step.name;
    names[original->name] = step.name;
    joined_.steps.push_back(std::move(step));
  }
  return names;
}

}  // namespace doorforge

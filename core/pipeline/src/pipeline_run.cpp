// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/pipeline_run.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"

#include "pipeline_state.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
using Values = std::map<std::string, std::vector<std::string>>;

template <class... Values>
std::string Format(const char* pattern, Values... values) {
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, pattern, values...)), ' ');
  std::snprintf(text.data(), text.size() + 1, pattern, values...);
  return text;
}

void Tell(const PipelineTextSink& sink, const std::string& text) {
  if (sink) sink(text);
}

/// What a step would be made from now, and what is to be done about it.
struct JudgedStep {
  StepInputs inputs;
  std::string output_sha256;  ///< It is that of what is there.
  StepDecision decision;
};

/// A pipeline in its folder: what stands for the placeholders, and what the steps' records say.
class Workshop {
 public:
  Workshop(const Pipeline& pipeline, const PipelineRun& run) : pipeline_(pipeline), run_(run) {
    values_["out"] = {run.out.string()};
    values_["threads"] = {std::to_string(run.threads)};
    for (const PipelineStep& step : pipeline.steps) values_[step.name] = FoldersOf(step);
  }

  const std::vector<std::string>& Folders(const PipelineStep& step) const {
    return values_.at(step.name);
  }

  std::vector<std::string> Command(const PipelineStep& step) const {
    return ExpandCommand(step, pipeline_.settings, values_);
  }

  /// A check that has been made leaves nothing that could change.
  std::string OutputHash(const PipelineStep& step) const {
    if (step.output.empty()) return "checked";
    return HashOfRecords(Folders(step), step.records);
  }

  /// `hashes`: of the outputs of earlier steps.
  JudgedStep Judge(const PipelineStep& step,
                   const std::map<std::string, std::string>& hashes) const {
    const std::optional<StepRecord> record = ReadStepRecord(run_.out, step.name);
    const std::string finished_by = record ? BuildThatFinished(*record) : "";
    const bool other = !finished_by.empty() && finished_by != CodeVersion();
    JudgedStep judged;
    judged.inputs = {{"build", other && run_.any_build ? finished_by : CodeVersion()},
                     {"command", HashedCommand(step)}};
    for (const std::string& need : step.needs) judged.inputs.emplace_back(need, hashes.at(need));
    judged.output_sha256 = OutputHash(step);
    judged.decision = Decide(record, judged.inputs, judged.output_sha256);
    if (other && judged.decision.action == StepAction::kSkip)
      judged.decision.why = "build " + finished_by + " made it, and nothing else has changed";
    return judged;
  }

 private:
  std::vector<std::string> FoldersOf(const PipelineStep& step) const {
    return step.given.empty() ? std::vector<std::string>{(run_.out / step.output).string()}
                              : step.given;
  }

  // neither the place of the folder nor the number of threads changes what is made
  std::string HashedCommand(const PipelineStep& step) const {
    std::string line;
    for (const std::string& argument : ExpandCommand(step, pipeline_.settings, {}))
      line += (line.empty() ? "" : " ") + argument;
    return line;
  }

  const Pipeline& pipeline_;
  const PipelineRun& run_;
  Values values_;
};

std::string Line(const std::vector<std::string>& command) {
  std::string line = "doorforge";
  for (const std::string& argument : command) line += " " + argument;
  return line;
}

void RequireGiven(const PipelineStep& step, const std::string& hash) {
  if (!hash.empty()) return;
  std::string folders;
  for (const std::string& folder : step.given) folders += " " + folder;
  throw Error(ErrorCode::kMissing,
              "--" + step.name + folders + ": no " + step.records[0] + " is in there at any depth");
}

const char* NameOf(StepAction action) {
  switch (action) {
    case StepAction::kSkip:
      return "skip";
    case StepAction::kStart:
      return "run";
    case StepAction::kResume:
      return "go on";
    case StepAction::kRestart:
      return "make anew";
  }
  return "";
}

// ---- running ------------------------------------------------------------------------------------

void PrepareFolder(const fs::path& out) {
  const bool foreign = fs::exists(out) &&
                       !(fs::is_directory(out) && fs::exists(out / "pipeline")) &&
                       !(fs::is_directory(out) && fs::is_empty(out));
  if (foreign)
    throw Error(ErrorCode::kInvalidArgument,
                out.string() + ": exists and is no pipeline's folder; choose another");
  SystemFiles().CreateFolder(out / "pipeline");
}

// What a step made with other inputs is removed before the step begins, so that an interruption
// never leaves the old behind a record that speaks of the new.
void ClearOutput(const PipelineStep& step, const PipelineRun& run, const StepDecision& decision) {
  if (step.output.empty()) return;
  const fs::path output = run.out / step.output;
  if (decision.action == StepAction::kStart) {
    if (fs::exists(output))
      throw Error(ErrorCode::kInvalidArgument, output.string() +
                                                   ": exists, and this pipeline did not make it; "
                                                   "move it away");
    return;
  }
  if (decision.action == StepAction::kResume && step.resume) return;
  if (decision.action == StepAction::kRestart && !run.overwrite && fs::exists(output))
    throw Error(ErrorCode::kInvalidArgument,
                "step " + step.name + " would replace " + output.string() + ", because " +
                    decision.why +
                    "; pass --overwrite to allow it, --any-build if only the build has changed, "
                    "or choose another --out");
  RemoveStepRecord(run.out, step.name);
  fs::remove_all(output);
}

int RunStep(const PipelineStep& step, const Workshop& workshop, const PipelineRun& run,
            bool resume) {
  std::vector<std::string> command = workshop.Command(step);
  if (resume && !step.resume->empty()) command.push_back(*step.resume);
  Tell(run.progress, "   $ " + Line(command) + "\n");
  command.insert(command.begin(), (ProgramFolder() / "doorforge").string());
  return RunChild(command, run.json ? ChildOutput::kStandardError : ChildOutput::kStandardOutput);
}

/// Brings one step to its end; the signal's exit code if it was stopped, else 0.
int Finish(const PipelineStep& step, Workshop& workshop, const PipelineRun& run,
           std::map<std::string, std::string>& hashes) {
  if (!step.given.empty()) {
    hashes[step.name] = workshop.OutputHash(step);
    RequireGiven(step, hashes[step.name]);
    Tell(run.progress, "   given\n");
    return 0;
  }
  const auto [inputs, output, decision] = workshop.Judge(step, hashes);
  Tell(run.progress, std::string("   ") + NameOf(decision.action) + ": " + decision.why + "\n");
  if (decision.action != StepAction::kSkip) {
    ClearOutput(step, run, decision);
    WriteStepRecord(run.out, step.name, {inputs, ""});
    const bool resume = decision.action == StepAction::kResume && step.resume.has_value();
    const int code = RunStep(step, workshop, run, resume);
    if (code == 130 || code == 143) return code;
    if (std::ranges::find(step.ok_exit_codes, code) == step.ok_exit_codes.end())
      throw Error(ErrorCode::kIncomplete, "step " + step.name + " ended with exit code " +
                                              std::to_string(code) + "; repair its cause and " +
                                              run.again);
  }
  hashes[step.name] = workshop.OutputHash(step);
  if (hashes[step.name].empty())
    throw Error(ErrorCode::kIncomplete, "step " + step.name + " left no " + step.records[0] +
                                            " in " + (run.out / step.output).string());
  if (decision.action != StepAction::kSkip)
    WriteStepRecord(run.out, step.name, {inputs, hashes[step.name]});
  return 0;
}

std::string SuccessText(const fs::path& report) {
  const std::string path = (report / "report.json").string();
  const Json json = ReadJsonFile(path);
  std::string text =
      Format("\n%-18s %8s   %s\n", "success > 45 deg", "rate", "95 % interval   episodes");
  for (const auto& [name, row] : MemberOf(json, "success", path).items()) {
    text +=
        Format("%-18s %6.1f %%   %.1f - %.1f %%   %d\n", name.c_str(),
               100 * ValueOf<double>(row, "rate", name), 100 * ValueOf<double>(row, "low", name),
               100 * ValueOf<double>(row, "high", name), ValueOf<int>(row, "episodes", name));
  }
  return text + "report: " + fs::absolute(report / "report.html").lexically_normal().string() +
         "\n";
}

// ---- planning -----------------------------------------------------------------------------------

struct PlannedStep {
  const PipelineStep* step = nullptr;
  std::vector<std::string> command;
  std::string action;
  std::string why;
  double seconds = 0;
  double mebibytes = 0;
};

std::vector<PlannedStep> Plan(const Pipeline& pipeline, const PipelineRun& run) {
  Workshop workshop(pipeline, run);
  std::map<std::string, std::string> hashes;
  std::vector<PlannedStep> planned;
  for (const PipelineStep& step : pipeline.steps) {
    PlannedStep row{&step, workshop.Command(step), "", "", 0, 0};
    const auto waits = std::ranges::find_if(
        step.needs, [&](const std::string& need) { return !hashes.contains(need); });
    if (!step.given.empty()) {
      hashes[step.name] = workshop.OutputHash(step);
      RequireGiven(step, hashes[step.name]);
      row.action = "given";
    } else if (waits != step.needs.end()) {
      const bool begun = ReadStepRecord(run.out, step.name).has_value();
      row.action = begun ? "look" : "run";
      row.why =
          begun ? "after " + *waits + ", unless that comes out as before" : "it has not run yet";
    } else {
      const auto [inputs, output, decision] = workshop.Judge(step, hashes);
      row.action = NameOf(decision.action);
      row.why = decision.why;
      if (decision.action == StepAction::kSkip) hashes[step.name] = output;
    }
    if (!hashes.contains(step.name)) {
      row.seconds = CostOf(step.core_seconds, pipeline.settings) / ThreadCount(run.threads);
      row.mebibytes = CostOf(step.mebibytes, pipeline.settings);
    }
    planned.push_back(row);
  }
  return planned;
}

Json PlanToJson(const Pipeline& pipeline, const std::vector<PlannedStep>& planned) {
  Json steps = Json::array();
  for (const PlannedStep& row : planned)
    steps.push_back({{"step", row.step->name},
                     {"action", row.action},
                     {"why", row.why},
                     {"command", row.command},
                     {"expected_s", row.seconds},
                     {"expected_mib", row.mebibytes}});
  return {{"schema", "doorforge.pipeline_plan"},
          {"schema_version", 1},
          {"pipeline", pipeline.name},
          {"settings", pipeline.settings},
          {"steps", steps}};
}

}  // namespace

int RunPipeline(const Pipeline& pipeline, const PipelineRun& run) {
  PrepareFolder(run.out);
  const auto lock = FileLock::Try(SystemFiles(), run.out / "pipeline" / "lock");
  Require(lock.has_value(), ErrorCode::kInvalidArgument,
          run.out.string() +
              ": another process runs a pipeline there; wait until it has ended, "
              "or choose another folder");
  const auto start = Clock::now();
  Workshop workshop(pipeline, run);
  std::map<std::string, std::string> hashes;
  for (std::size_t i = 0; i < pipeline.steps.size(); ++i) {
    const PipelineStep& step = pipeline.steps[i];
    const std::chrono::duration<double> elapsed = Clock::now() - start;
    Tell(run.progress, Format("\n== %zu/%zu %s: %s   (at %.0f s)\n", i + 1, pipeline.steps.size(),
                              step.name.c_str(), step.does.c_str(), elapsed.count()));
    int code = StopRequested() == 0 ? 0 : 128 + StopRequested();
    if (code == 0) code = Finish(step, workshop, run, hashes);
    if (code == 0) continue;
    Tell(run.progress, "doorforge: stopped; to go on, " + run.again + "\n");
    return code;
  }
  for (const PipelineStep& step : pipeline.steps) {
    if (!step.output.empty() && fs::exists(run.out / step.output / "report.json"))
      Tell(run.result, SuccessText(run.out / step.output));
  }
  return 0;
}

std::string PlanPipeline(const Pipeline& pipeline, const PipelineRun& run) {
  const std::vector<PlannedStep> planned = Plan(pipeline, run);
  if (run.json) return JsonText(PlanToJson(pipeline, planned), 2) + "\n";
  double minutes = 0;
  double mebibytes = 0;
  int width = 14;
  for (const PlannedStep& row : planned)
    width = std::max(width, static_cast<int>(row.step->name.size()));
  std::string text =
      Format("%-*s %-10s %9s %10s   %s\n", width, "step", "", "minutes", "MiB", "why");
  for (const PlannedStep& row : planned) {
    minutes += row.seconds / 60;
    mebibytes += row.mebibytes;
    text += Format("%-*s %-10s %9.1f %10.0f   %s\n", width, row.step->name.c_str(),
                   row.action.c_str(), row.seconds / 60, row.mebibytes, row.why.c_str());
  }
  return text + Format(
                    "%-*s %-10s %9.1f %10.0f   on %d threads, by the arithmetic of "
                    "docs/pipeline.md\n",
                    width, "together", "", minutes, mebibytes, ThreadCount(run.threads));
}

bool TakePlan(std::vector<std::string>& words) {
  if (words.size() < 2) return false;
  Require(words[0] == "plan", ErrorCode::kInvalidArgument,
          "\"" + words[0] + "\": expected one name, or `plan` and one");
  words.erase(words.begin());
  return true;
}

}  // namespace doorforge

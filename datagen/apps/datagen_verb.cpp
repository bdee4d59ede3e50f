// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "datagen_verb.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "doorforge/collect/forecast.h"
#include "doorforge/collect/stage_run.h"
#include "doorforge/collect/trained_policy.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/free_space.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/task_number.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "slurm_verb.h"
#include "verb_options.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  Stage stage = Stage::kOpen;
  std::vector<std::string> doors;
  PolicyFolders policies;
  std::string robot;
  std::string out;
  std::string config;
  std::vector<std::string> settings;
  std::optional<std::uint64_t> episodes;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  int probe = 8;
  std::string task;
  int tasks = 0;
  int task_offset = 0;
  SlurmOptions slurm;
  bool resume = false;
  bool overwrite = false;
  bool json = false;
};

void AddOptions(CLI::App& app, Options& options) {
  app.add_option("--doors", options.doors,
                 "folders of composed doors; with a split such as full:train only its doors")
      ->required();
  app.add_option("--episodes", options.episodes, "episodes to run, failed ones included")
      ->check(CLI::Range(1, 10000000));
  app.add_option("--seed", options.seed, "decides every random choice");
  app.add_option("--opener", options.policies.opener,
                 "trained policy that opens, instead of the rule (handle, grasp)");
  app.add_option("--handler", options.policies.handler,
                 "trained policy that turns the handle, instead of the rule (grasp)");
  app.add_option("--learner", options.policies.learner,
                 "trained policy of this stage that drives and is corrected by the rule (open, "
                 "handle; config: learner_decisions), or whose grasps are tried (grasp)");
  app.add_option("--robot", options.robot, "URDF of the robot; the embedded one if left out");
  app.add_option("--config", options.config, "YAML file with settings");
  AddSettings(app, options.settings, "a.b=c overrides one setting, e.g. cloud.point_count");
  app.add_option("-j,--threads", options.threads, "threads, 0: all; does not change the bytes")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print one JSON document");
}

// What belongs to a run that writes.
void AddOutput(CLI::App& app, Options& options) {
  app.add_option("--out", options.out, "folder of the dataset")->required();
  app.add_option("--task", options.task,
                 "i/N: only task i, from 0, of N; `doorforge dataset merge` joins them");
  app.add_option("--tasks", options.tasks,
                 "N: the same, with i from SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX; with "
                 "--slurm the number of tasks")
      ->check(CLI::Range(1, kMostTasks));
  app.add_option("--task-offset", options.task_offset, "added to the i of --tasks")
      ->check(CLI::Range(0, kMostTasks));
  app.add_flag("--resume", options.resume,
               "go on in --out, which is done without it where the settings are the same");
  app.add_flag("--overwrite", options.overwrite, "replace the dataset in --out");
  AddSlurmOptions(app, options.slurm);
}

StageRequest RequestOf(const Options& options) {
  StageConfig config =
      LoadConfig<StageConfig>(options.config, options.settings, DefaultsOf(options.stage));
  if (options.episodes) config.episodes = *options.episodes;
  if (options.seed) config.seed = *options.seed;
  if (!options.robot.empty()) config.scene.robot = options.robot;
  return {config, options.doors, options.policies, options.threads, RobotMeshes()};
}

// Whether there is nothing but what a writer leaves that was killed at its first file, or has while
// it writes.
bool HoldsNothing(const fs::path& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const fs::directory_entry& entry) {
                       const std::string name = entry.path().filename().string();
                       return name.starts_with(".config.yaml.tmp-") ||
                              name == FolderLock::kFileName;
                     });
}

// All but the lock of whoever removes it.
void RemoveDataset(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != FolderLock::kFileName) fs::remove_all(entry.path());
  }
}

// Whether the folder is one to go on in is decided where config.yaml is compared.
void PrepareFolder(const Options& options) {
  const fs::path out = options.out;
  if (HoldsNothing(out)) return;
  if (!fs::exists(out / "config.yaml"))
    throw Error(ErrorCode::kInvalidArgument,
                options.out +
                    ": exists and holds no dataset (no config.yaml); choose another "
                    "folder");
  if (!options.overwrite) return;
  RequireKind(out, kDatasetFolder);
  RemoveDataset(out);
}

// The tasks of a collection write side by side; who replaces what is there writes alone.
FolderLock LockOf(const Options& options) {
  Require(!fs::exists(options.out) || fs::is_directory(options.out), ErrorCode::kInvalidArgument,
          options.out + ": is a file; --out takes a folder");
  return {options.out, "doorforge datagen", options.overwrite ? Writers::kOne : Writers::kTogether};
}

CollectionTask TaskOf(const Options& options) {
  Require(options.task.empty() || options.tasks == 0, ErrorCode::kInvalidArgument,
          "--task and --tasks: give one of them");
  Require(options.task_offset == 0 || options.tasks > 0, ErrorCode::kInvalidArgument,
          "--task-offset: belongs to --tasks");
  if (options.tasks > 0) return TaskFromEnvironment(options.tasks, options.task_offset);
  const CollectionTask task = options.task.empty() ? CollectionTask{} : ParseTask(options.task);
  Require(task.count == 1 || !options.overwrite, ErrorCode::kInvalidArgument,
          "--overwrite: would remove what other tasks have written; remove the folder first");
  return task;
}

nlohmann::ordered_json TaskToJson(const CollectSummary& summary, const CollectionTask& task) {
  return {{"schema", "doorforge.collection_task"},
          {"schema_version", 1},
          {"task", task.number},
          {"tasks", task.count},
          {"shards", summary.shards},
          {"episodes", summary.written},
          {"failures", summary.failures},
          {"bytes", summary.bytes}};
}

int FinishTask(const CollectSummary& summary, const CollectionTask& task, const Options& options) {
  if (options.json) {
    std::cout << JsonText(TaskToJson(summary, task), 2) << '\n';
  } else {
    std::printf("task %d/%d: %llu shards, %llu of %llu episodes succeeded, %.1f MiB in %s\n",
                task.number, task.count, static_cast<unsigned long long>(summary.shards),
                static_cast<unsigned long long>(summary.written),
                static_cast<unsigned long long>(summary.planned),
                static_cast<double>(summary.bytes) / (1 << 20), options.out.c_str());
  }
  return 0;
}

int Finish(const CollectSummary& summary, const CollectionTask& task, const Options& options) {
  if (summary.stopped_by_signal != 0) {
    std::fprintf(stderr,
                 "doorforge: stopped; what is done is kept in %s, the same command goes on\n",
                 options.out.c_str());
    return 128 + summary.stopped_by_signal;
  }
  if (task.count > 1) return FinishTask(summary, task, options);
  const nlohmann::ordered_json description = DescribeDataset(options.out);
  std::cout << (options.json ? JsonText(description, 2) + "\n" : DescriptionText(description));
  if (summary.written > 0) return 0;
  std::fprintf(stderr, "doorforge: no episode succeeded; %s lists the causes\n",
               (fs::path(options.out) / "failures.jsonl").c_str());
  return 1;
}

// Refuses what certainly has no room, and warns where there may be none: episodes have about 16
// decisions where they open, 1 to 25 in general, and clouds are nearly all of their bytes.
void RequireSpaceForShards(const Options& options, const StageRun& run,
                           const CollectionTask& task) {
  constexpr double kBytesAPoint = 13;
  const double decisions = run.config().stage == Stage::kGrasp ? 1 : 16;
  const double whole = static_cast<double>(run.config().episodes) * decisions * kBytesAPoint *
                       run.config().cloud.point_count / task.count;
  const double needed = whole - BytesBelow(options.out);
  const std::string lack = LackOfSpace(options.out, needed);
  if (lack.empty()) return;
  const std::string text = lack + "; make room, choose another --out, or ask for fewer --episodes";
  if (!LackOfSpace(options.out, needed / 4).empty()) throw Error(ErrorCode::kIo, text);
  std::fprintf(stderr, "doorforge: warning: %s\n", text.c_str());
}

int CollectStage(const Options& options) {
  const CollectionTask task = TaskOf(options);
  StageRun run(RequestOf(options));
  const FolderLock lock = LockOf(options);
  PrepareFolder(options);
  RequireSpaceForShards(options, run, task);
  CollectRequest request = run.Request();
  request.folder = options.out;
  request.threads = options.threads;
  request.task = task;
  const CollectSummary summary = Collect(
      run.plan(), [&](const PlannedEpisode& planned) { return run.Run(planned); }, request);
  return Finish(summary, task, options);
}

int GiveToSlurm(const Options& options, std::vector<std::string> arguments) {
  Require(options.task.empty() && options.task_offset == 0, ErrorCode::kInvalidArgument,
          "--task and --task-offset: --slurm numbers the tasks itself; give --tasks N");
  const StageRun run(RequestOf(options));
  {
    const FolderLock lock = LockOf(options);
    PrepareFolder(options);
  }
  return RunSlurm(
      {options.out, std::move(arguments), options.tasks, options.threads, run.plan().shards.size()},
      options.slurm, options.overwrite ? Existing::kReplace : Existing::kRefuse);
}

int PrintPlan(const Options& options) {
  StageRun run(RequestOf(options));
  const CollectionForecast forecast = Forecast(run, options.probe, options.threads);
  std::cout << (options.json ? JsonText(ForecastToJson(forecast), 2) + "\n"
                             : ForecastText(forecast));
  return 0;
}

void AddStage(CLI::App& app, Options& options, Stage stage, const std::string& description) {
  const std::string name(NameOf(stage));
  auto* verb = app.add_subcommand(name, description);
  AddOptions(*verb, options);
  AddOutput(*verb, options);
  const std::string command = "  doorforge datagen " + name +
                              " --doors full:train doors --out data --episodes 2000 --seed 7";
  verb->footer(
      "Interrupted with Ctrl-C or killed, the same command goes on and gives the same bytes.\n\n"
      "examples:\n" +
      command + "\n" + command + (stage == Stage::kOpen ? " --task 3/16" : " --opener run/opener"));
  verb->callback([&options, stage] { options.stage = stage; });
}

CLI::App* AddPlan(CLI::App& app, Options& options) {
  auto* plan = app.add_subcommand(
      "plan",
      "what a collection would be: doors, episodes, decisions, bytes and time; writes nothing");
  plan->add_option_function<std::string>(
          "stage", [&options](const std::string& name) { options.stage = *StageNamed(name); },
          "open, handle or grasp")
      ->required()
      ->check(CLI::IsMember({"open", "handle", "grasp"}));
  AddOptions(*plan, options);
  plan->add_option("--probe", options.probe, "episodes that are run and measured for it; 0: none")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  plan->footer(
      "example:\n  doorforge datagen plan open --doors full:train doors --episodes 100000");
  return plan;
}

}  // namespace

int RunDatagenVerb(int argc, char** argv) {
  Options options;
  CLI::App app("Collects a stage's dataset.", "doorforge datagen");
  app.require_subcommand(1);
  AddStage(app, options, Stage::kOpen,
           "grasp and unlock by rule, then every decision of opening is recorded");
  AddStage(app, options, Stage::kHandle,
           "grasp by rule, then every decision of turning the handle is recorded, of episodes in "
           "which the door opens afterwards");
  AddStage(
      app, options, Stage::kGrasp,
      "sampled contact points and orientations, good and bad ones alike, with the door's final "
      "angle");
  const CLI::App* plan = AddPlan(app, options);
  app.footer("example:\n  doorforge datagen open --doors doors/train --out data --episodes 200");
  ParseDataVerb(app, argc, argv);
  if (!options.slurm.file.empty()) return GiveToSlurm(options, {argv, argv + argc});
  return NamingConfig(options.config,
                      [&] { return plan->parsed() ? PrintPlan(options) : CollectStage(options); });
}

}  // namespace doorforge

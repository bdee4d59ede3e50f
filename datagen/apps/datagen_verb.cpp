// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/collect/collect_stage.h"
#include "doorforge/collect/collection_script.h"
#include "doorforge/collect/forecast.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/environment_preset.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/task_number.h"
#include "doorforge/dataset/task_summary.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct DatagenOptions {
  Stage stage = Stage::kOpen;
  std::vector<std::string> doors;
  CollectionWords policies;
  std::string robot;
  std::string out;
  ConfigSources config;
  std::optional<std::uint64_t> episodes;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  int probe = 8;
  std::string task;
  int tasks = 0;
  int task_offset = 0;
  std::string script_file;  // for Slurm; empty: the collection is run here
  SlurmScript script;
  bool submit = false;
  bool resume = false;
  bool overwrite = false;
  bool json = false;
};

void AddOptions(CLI::App& app, DatagenOptions& options) {
  app.add_option("--doors", options.doors,
                 "folders of composed doors; with a split such as full:train only its doors")
      ->required();
  app.add_option("--episodes", options.episodes, "episodes to run, failed ones included")
      ->check(CLI::Range(1, 10000000));
  app.add_option("--seed", options.seed, "decides every random choice");
  AddWord(app, "--opener", options.policies.opener,
          "who opens (handle, grasp): " + BuiltInPolicies().Choices(Stage::kOpen));
  AddWord(app, "--handler", options.policies.handler,
          "who turns the handle (grasp): " + BuiltInPolicies().Choices(Stage::kHandle));
  app.add_option("--learner", options.policies.learner,
                 "trained policy of this stage that drives and is corrected by the expert (open, "
                 "handle; config: learner_decisions), or whose grasps are tried (grasp)");
  app.add_option("--robot", options.robot, "URDF of the robot; the embedded one if left out");
  AddPreset(app, options.config.preset);
  AddConfig(app, options.config.file, "YAML file with settings");
  AddSettings(app, options.config.settings, "a.b=c overrides one setting, e.g. cloud.point_count");
  AddThreads(app, options.threads, "threads, 0: all; does not change the bytes");
  AddJson(app, options.json);
}

// What gives a collection to Slurm instead of running it here.
void AddSlurmOptions(CLI::App& app, DatagenOptions& options) {
  SlurmScript& script = options.script;
  auto* file = app.add_option("--slurm", options.script_file,
                              "write a script that runs this collection as Slurm arrays of --tasks "
                              "tasks, with the merge and the verification after them");
  app.add_flag("--submit", options.submit, "and submit it")->needs(file);
  app.add_option("--slurm-array", script.array_size, "Slurm's MaxArraySize")
      ->check(CLI::Range(1, 4000001))
      ->capture_default_str()
      ->needs(file);
  app.add_option("--slurm-parallel", script.parallel, "most tasks of an array at once, 0: all")
      ->check(CLI::Range(0, 4000001))
      ->needs(file);
  app.add_option("--slurm-memory", script.memory, "a task's memory, as sbatch --mem takes it")
      ->capture_default_str()
      ->needs(file);
  app.add_option("--slurm-option", script.options, "another one for sbatch: --partition=long")
      ->needs(file);
}

// What belongs to a run that writes.
void AddOutput(CLI::App& app, DatagenOptions& options) {
  app.add_option("--out", options.out, "folder of the dataset")->required();
  auto* task =
      app.add_option("--task", options.task,
                     "i/N: only task i, from 0, of N; `doorforge dataset merge` joins them");
  auto* tasks =
      app.add_option("--tasks", options.tasks,
                     "N: the same, with i from SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX; with "
                     "--slurm the number of tasks")
          ->check(CLI::Range(1, kMostTasks))
          ->excludes(task);
  app.add_option("--task-offset", options.task_offset, "added to the i of --tasks")
      ->check(CLI::Range(0, kMostTasks))
      ->needs(tasks);
  app.add_flag("--resume", options.resume,
               "go on in --out, which is done without it where the settings are the same");
  app.add_flag("--overwrite", options.overwrite, "replace the dataset in --out");
  AddSlurmOptions(app, options);
}

StageRequest RequestOf(const DatagenOptions& options) {
  StageConfig config = LoadConfig<StageConfig>(options.config, DefaultsOf(options.stage));
  if (options.episodes) config.episodes = *options.episodes;
  if (options.seed) config.seed = *options.seed;
  if (!options.robot.empty()) config.scene.robot = options.robot;
  return {config, options.doors, options.policies, options.threads, RobotMeshes()};
}

CollectionTask TaskOf(const DatagenOptions& options) {
  if (options.tasks > 0) return TaskFromEnvironment(options.tasks, options.task_offset);
  const CollectionTask task = options.task.empty() ? CollectionTask{} : ParseTask(options.task);
  Require(task.count == 1 || !options.overwrite, ErrorCode::kInvalidArgument,
          "--overwrite: would remove what other tasks have written; remove the folder first");
  return task;
}

int Finish(const CollectSummary& summary, const CollectionTask& task,
           const DatagenOptions& options) {
  if (summary.stopped_by_signal != 0)
    return ExitCodeOfStopped(summary.stopped_by_signal, "what is done is kept in " + options.out +
                                                            ", the same command goes on");
  if (task.count > 1) {
    PrintAnswer(options.json, TaskSummaryToJson(summary, task),
                TaskSummaryText(summary, task, options.out));
    return 0;
  }
  const nlohmann::ordered_json description = DescribeDataset(options.out);
  PrintAnswer(options.json, description, DescriptionText(description));
  if (summary.written > 0) return 0;
  PrintNote("no episode succeeded; " + (fs::path(options.out) / "failures.jsonl").string() +
            " lists the causes");
  return 1;
}

int CollectOrGoOn(const DatagenOptions& options) {
  const CollectionTask task = TaskOf(options);
  const auto warn = [](const std::string& text) { PrintNote("warning: " + text); };
  const CollectSummary summary =
      CollectStage({RequestOf(options), options.out, task, options.overwrite, warn});
  return Finish(summary, task, options);
}

int GiveToSlurm(const DatagenOptions& options, const std::vector<std::string>& arguments) {
  Require(options.task.empty() && options.task_offset == 0, ErrorCode::kInvalidArgument,
          "--task and --task-offset: --slurm numbers the tasks itself; give --tasks N");
  SlurmScript script = options.script;
  script.dataset = options.out;
  script.arguments = arguments;
  script.tasks = options.tasks;
  script.threads = options.threads;
  const std::string& file = options.script_file;
  PrintNote(ScriptText(WriteCollectionScript({RequestOf(options), file, script, options.overwrite}),
                       file));
  if (options.submit) return RunChild({"/bin/bash", fs::absolute(file).string()});
  PrintText("bash " + file + "\n");
  return 0;
}

int PrintPlan(const DatagenOptions& options) {
  StageRun run(RequestOf(options));
  const CollectionForecast forecast = Forecast(run, options.probe, options.threads);
  PrintAnswer(options.json, ForecastToJson(forecast), ForecastText(forecast));
  return 0;
}

void AddStage(CLI::App& app, DatagenOptions& options, Stage stage, const std::string& description) {
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

CLI::App* AddPlan(CLI::App& app, DatagenOptions& options) {
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
  DatagenOptions options;
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
  ParseVerb(app, argc, argv, EmptyValues::kRefuse);
  if (!options.script_file.empty()) return GiveToSlurm(options, {argv, argv + argc});
  return NamingConfig(options.config.Named(),
                      [&] { return plan->parsed() ? PrintPlan(options) : CollectOrGoOn(options); });
}

}  // namespace doorforge

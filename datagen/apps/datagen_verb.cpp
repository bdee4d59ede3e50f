// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "datagen_verb.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/config_file.h"
#include "doorforge/core/program.h"
#include "doorforge/datagen/describe_dataset.h"
#include "doorforge/datagen/task_number.h"
#include "doorforge/rollout/run_episode.h"

#include "door_folder.h"
#include "open_stage.h"
#include "robot_meshes.h"
#include "verb_options.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string doors;
  std::string robot;
  std::string out;
  std::string config;
  std::vector<std::string> settings;
  std::optional<std::uint64_t> episodes;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  std::string task;
  int tasks = 0;
  int task_offset = 0;
  bool resume = false;
  bool overwrite = false;
  bool json = false;
};

void AddOptions(CLI::App& app, Options& options) {
  app.add_option("--doors", options.doors, "folder of composed doors")->required();
  app.add_option("--out", options.out, "folder of the dataset")->required();
  app.add_option("--episodes", options.episodes, "episodes to run, failed ones included")
      ->check(CLI::Range(1, 100000000));
  app.add_option("--seed", options.seed, "decides every random choice");
  app.add_option("--robot", options.robot, "URDF of the robot; the embedded one if left out");
  app.add_option("--config", options.config, "YAML file with settings");
  app.add_option("--set", options.settings, "a.b=c overrides one setting, e.g. cloud.point_count");
  app.add_option("--threads", options.threads, "threads, 0: all; does not change the bytes")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--task", options.task,
                 "i/N: only task i, from 0, of N; `doorforge dataset merge` joins them");
  app.add_option("--tasks", options.tasks,
                 "N: the same, with i from SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX")
      ->check(CLI::Range(1, kMostTasks));
  app.add_option("--task-offset", options.task_offset, "added to the i of --tasks")
      ->check(CLI::Range(0, kMostTasks));
  app.add_flag("--resume", options.resume,
               "go on in --out, which is done without it where the settings are the same");
  app.add_flag("--overwrite", options.overwrite, "replace the dataset in --out");
  app.add_flag("--json", options.json, "print one JSON document");
  app.footer(
      "Interrupted with Ctrl-C or killed, the same command goes on and gives the same bytes.\n\n"
      "examples:\n"
      "  doorforge datagen open --doors doors/train --out data --episodes 2000 --seed 7\n"
      "  doorforge datagen open --doors doors/train --out data --episodes 2000 --seed 7 --task "
      "3/16");
}

OpenStageConfig LoadOpenConfig(const Options& options) {
  auto config = LoadConfig<OpenStageConfig>(options.config, options.settings);
  if (options.episodes) config.episodes = *options.episodes;
  if (options.seed) config.seed = *options.seed;
  if (!options.robot.empty()) config.scene.robot = options.robot;
  Require(config.cloud.point_count >= 1 && config.cloud.point_count <= 1000000,
          ErrorCode::kInvalidConfig, "config.cloud.point_count: out of 1..1000000");
  CheckDepthNoise(config.cloud.noise);
  return config;
}

// The effective config. A comment names what else decides the bytes, so that a run on other doors
// or with another build is noticed when it is resumed.
std::string ConfigText(const OpenStageConfig& config, const DoorFolder& doors,
                       const RobotModel& robot) {
  return "# doorforge datagen open, " + CodeVersion() + "\n# " +
         std::to_string(doors.doors.size()) + " doors, sha256 " + ContentHash(doors) +
         "\n# robot " +
         (robot.name().empty() ? "embedded" : robot.name() + ", sha256 " + robot.sha256()) +
         ", rays by " + RayCasterVersion() + "\n" + ToJson(config).dump(2) + "\n";
}

// Whether there is nothing but what a writer leaves that was killed at its first file.
bool HoldsNothing(const fs::path& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const fs::directory_entry& entry) {
                       return entry.path().filename().string().starts_with(".config.yaml.tmp-");
                     });
}

// Whether the folder is one to go on in is decided where config.yaml is compared.
void PrepareFolder(const Options& options) {
  const fs::path out = options.out;
  if (!fs::exists(out) || HoldsNothing(out)) {
    fs::create_directories(out);
    return;
  }
  if (!fs::exists(out / "config.yaml"))
    throw Error(ErrorCode::kInvalidArgument,
                options.out +
                    ": exists and holds no dataset (no config.yaml); choose another "
                    "folder");
  if (!options.overwrite) return;
  fs::remove_all(out);
  fs::create_directories(out);
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

DatasetProvenance ProvenanceOf(const OpenStageConfig& config, const DoorFolder& doors) {
  DatasetProvenance provenance;
  provenance.code_version = CodeVersion();
  provenance.compiler = __VERSION__;
  provenance.libraries = {{"ray_caster", RayCasterVersion()}};
  provenance.seed = config.seed;
  provenance.doors = doors.doors;
  return provenance;
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
    std::cout << TaskToJson(summary, task).dump(2) << '\n';
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
  std::cout << (options.json ? description.dump(2) + "\n" : DescriptionText(description));
  if (summary.written > 0) return 0;
  std::fprintf(stderr, "doorforge: no episode succeeded; %s lists the causes\n",
               (fs::path(options.out) / "failures.jsonl").c_str());
  return 1;
}

int CollectOpenStage(const Options& options) {
  const OpenStageConfig config = LoadOpenConfig(options);
  const CollectionTask task = TaskOf(options);
  const DoorFolder doors = ReadDoorFolder(options.doors, options.threads);
  const RobotModel robot =
      LoadRobot(config.scene.robot, RobotBaseNamed(config.scene.physics.base), RobotMeshes());
  Require(HasProprioception(robot), ErrorCode::kInvalidArgument,
          "config.scene: data are recorded for robots with two sliders or a fixed base, seven arm "
          "joints and two fingers; let others open doors with `doorforge simulate`");
  const CollectionPlan plan =
      MakePlan(PartsOf(doors), config.episodes, config.seed, config.collection);
  PrepareFolder(options);
  CollectRequest request;
  request.folder = options.out;
  request.config_text = ConfigText(config, doors, robot);
  request.provenance = ProvenanceOf(config, doors);
  request.threads = options.threads;
  request.task = task;
  DoorShelf shelf(doors);
  const CollectSummary summary = Collect(
      plan,
      [&](const PlannedEpisode& planned) {
        return RunOpenEpisode(planned, *shelf.Take(planned.door), robot, config);
      },
      request);
  return Finish(summary, task, options);
}

}  // namespace

int RunDatagenVerb(int argc, char** argv) {
  Options options;
  CLI::App app("Collects a stage's dataset.", "doorforge datagen");
  app.require_subcommand(1);
  auto* open = app.add_subcommand(
      "open",
      "expert episodes of the opening stage: grasp and unlock by rule, then every decision "
      "of opening is recorded");
  AddOptions(*open, options);
  app.footer("example:\n  doorforge datagen open --doors doors/train --out data --episodes 200");
  ParseVerb(app, argc, argv);
  return CollectOpenStage(options);
}

}  // namespace doorforge

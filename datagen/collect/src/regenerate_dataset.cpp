// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/regenerate_dataset.h"

#include <algorithm>
#include <memory>

#include "doorforge/collect/stage_run.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"

#include "recorded_robot.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Stage StageOf(const fs::path& folder) {
  const fs::path path = folder / "provenance.json";
  const DatasetProvenance provenance = ProvenanceFromJson(ReadJsonFile(path), path.string());
  const auto stage =
      provenance.planned.empty() ? std::nullopt : StageNamed(provenance.planned[0].stage);
  Require(stage.has_value(), ErrorCode::kInvalidArgument,
          path.string() + ": names no plan; datasets of earlier builds cannot be made again");
  return *stage;
}

// Build, doors, ray caster and policies are named in the config's comment.
void RequireSameConfig(const fs::path& path, const std::string& now) {
  const std::string text = ReadFile(path);
  if (text == now) return;
  throw Error(ErrorCode::kInvalidArgument,
              path.string() +
                  ": made with another build, other doors or policies, so its bytes are not "
                  "expected again" +
                  ConfigDifference(text, now));
}

// The collection as it was run.
std::unique_ptr<StageRun> RecordedRun(const RegenerateDatasetRequest& request) {
  const Stage stage = StageOf(request.folder);
  const std::string config_file = (request.folder / "config.yaml").string();
  auto config = LoadConfig<StageConfig>(config_file, {}, DefaultsOf(stage));
  const std::string robot = RecordedRobot(request.folder, config.scene.robot, request.robot);
  // the config, whose text is compared, goes on naming the file as it did
  std::error_code error;
  Require(robot == config.scene.robot || fs::equivalent(robot, config.scene.robot, error),
          ErrorCode::kInvalidArgument,
          config_file + ": names the robot \"" + config.scene.robot +
              "\", which is another file than --robot " + robot);
  auto run = std::make_unique<StageRun>(
      StageRequest{config, request.doors, request.policies, request.threads, request.robot_meshes});
  RequireSameConfig(config_file, run->Request().config_text);
  return run;
}

struct RecordedFailure {
  const PlannedEpisode* planned;
  FailedEpisode failure;
};

std::vector<RecordedFailure> FailuresOf(const fs::path& folder, const StageRun& run) {
  std::vector<RecordedFailure> failures;
  for (const PlannedShard& shard : run.plan().shards) {
    const ShardReader reader(folder / NameOf(run.config().stage) / shard.split /
                             (ShardStem(shard.number) + ".index.json"));
    for (const PlannedEpisode& planned : shard.episodes) {
      const auto& failed = reader.index().failures;
      const auto found = std::ranges::find(failed, planned.key, &FailedEpisode::key);
      if (found != failed.end()) failures.push_back({&planned, *found});
    }
  }
  return failures;
}

}  // namespace

RegenerateResult RegenerateDataset(const RegenerateDatasetRequest& request) {
  const auto run = RecordedRun(request);
  return RegenerateEpisodes(run->plan(),
                            [&](const PlannedEpisode& planned) { return run->Run(planned); },
                            {request.folder, std::string(NameOf(run->config().stage)),
                             request.fraction, request.threads});
}

std::vector<EpisodeFilm> FilmFailures(const RegenerateDatasetRequest& request) {
  const auto run = RecordedRun(request);
  const std::vector<RecordedFailure> failures = FailuresOf(request.folder, *run);
  std::vector<EpisodeFilm> films(failures.size());
  Progress progress("films", failures.size());
  ParallelFor(failures.size(), request.threads, [&](std::size_t i) {
    const auto& [planned, failure] = failures[i];
    films[i] = run->Film(*planned);
    Require(NameOf(films[i].outcome) == failure.outcome && films[i].detail == failure.detail,
            ErrorCode::kInvalidArgument,
            planned->key + ": made again it ends as " + std::string(NameOf(films[i].outcome)) +
                ", recorded is " + failure.outcome);
    progress.Advance();
  });
  return films;
}

}  // namespace doorforge

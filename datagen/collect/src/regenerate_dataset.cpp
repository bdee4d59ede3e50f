// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/regenerate_dataset.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "doorforge/collect/stage_run.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/schemas/episode_arrays.h"

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

// An episode of the plan, and how it ended as it is recorded.
struct RecordedEpisode {
  const PlannedEpisode* planned;
  std::string outcome;
  std::string detail;
  std::string state_sha256;  // empty: not recorded, as of failures
};

std::optional<RecordedEpisode> FailureOf(const ShardReader& shard, const PlannedEpisode& planned) {
  const auto& failed = shard.index().failures;
  const auto found = std::ranges::find(failed, planned.key, &FailedEpisode::key);
  if (found == failed.end()) return std::nullopt;
  return RecordedEpisode{&planned, found->outcome, found->detail, ""};
}

std::optional<RecordedEpisode> StoredOf(const ShardReader& shard, const PlannedEpisode& planned) {
  const auto& stored = shard.index().episodes;
  const auto found = std::ranges::find(stored, planned.key, &ShardEpisode::key);
  if (found == stored.end()) return std::nullopt;
  const auto place = static_cast<std::size_t>(found - stored.begin());
  const Episode episode =
      EpisodeFromMeta(ReadEpisodeMeta(shard, place), shard.Describe(place, "meta.json"));
  return RecordedEpisode{&planned, std::string(NameOf(episode.outcome)), episode.detail,
                         episode.state_sha256};
}

std::vector<RecordedEpisode> RecordedOf(const FilmDatasetRequest& request, const StageRun& run) {
  const std::size_t most = request.stored > 0 ? static_cast<std::size_t>(request.stored)
                                              : std::numeric_limits<std::size_t>::max();
  std::vector<RecordedEpisode> recorded;
  for (const PlannedShard& shard : run.plan().shards) {
    const ShardReader reader(request.made_with.folder / NameOf(run.config().stage) / shard.split /
                             (ShardStem(shard.number) + ".index.json"));
    for (const PlannedEpisode& planned : shard.episodes) {
      if (recorded.size() >= most) return recorded;
      const auto found =
          request.stored > 0 ? StoredOf(reader, planned) : FailureOf(reader, planned);
      if (found) recorded.push_back(*found);
    }
  }
  return recorded;
}

void RequireSameEnd(const RecordedEpisode& recorded, const EpisodeFilm& film) {
  const bool same_state =
      recorded.state_sha256.empty() || recorded.state_sha256 == film.state_sha256;
  Require(NameOf(film.outcome) == recorded.outcome && film.detail == recorded.detail && same_state,
          ErrorCode::kInvalidArgument,
          recorded.planned->key + ": made again it ends as " + std::string(NameOf(film.outcome)) +
              ", recorded is " + recorded.outcome +
              (same_state ? "" : " with another final state"));
}

}  // namespace

RegenerateResult RegenerateDataset(const RegenerateDatasetRequest& request) {
  const auto run = RecordedRun(request);
  return RegenerateEpisodes(run->plan(),
                            [&](const PlannedEpisode& planned) { return run->Run(planned); },
                            {request.folder, std::string(NameOf(run->config().stage)),
                             request.fraction, request.threads});
}

ThoroughFindings VerifyThoroughly(ThoroughVerification request) {
  RegenerateDatasetRequest& again = request.regenerate;
  if (!request.share.empty()) again.fraction = ParseFraction(request.share);
  ThoroughFindings found;
  {
    Progress progress("verify", CountShards(request.verify.folder));
    request.verify.on_shard = [&] { progress.Advance(); };
    found.findings = VerifyDataset(request.verify);
  }
  if (request.share.empty() || AnyFault(found.findings)) return found;
  again.folder = request.verify.folder;
  again.threads = request.verify.threads;
  const RegenerateResult result = RegenerateDataset(again);
  found.note = std::to_string(result.episodes) + " episodes made again, " +
               std::to_string(result.findings.size()) + " differences";
  found.findings.insert(found.findings.end(), result.findings.begin(), result.findings.end());
  return found;
}

std::vector<EpisodeFilm> FilmDataset(const FilmDatasetRequest& request) {
  const auto run = RecordedRun(request.made_with);
  const std::vector<RecordedEpisode> recorded = RecordedOf(request, *run);
  std::vector<EpisodeFilm> films(recorded.size());
  Progress progress("films", recorded.size());
  ParallelFor(recorded.size(), request.made_with.threads, [&](std::size_t i) {
    films[i] = run->Film(*recorded[i].planned);
    RequireSameEnd(recorded[i], films[i]);
    progress.Advance();
  });
  return films;
}

}  // namespace doorforge

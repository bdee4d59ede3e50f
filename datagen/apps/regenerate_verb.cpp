// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "regenerate_verb.h"

#include <cstdio>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/datagen/regenerate.h"

#include "datagen_verb.h"
#include "recorded_robot.h"
#include "stage_run.h"
#include "trained_policy.h"

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

}  // namespace

void AddRegenerateOptions(CLI::App& app, RegenerateOptions& options) {
  auto* share = app.add_option("--regenerate", options.share,
                               "make a share of the episodes again from their seeds, such as 1%, "
                               "and compare every byte");
  app.add_option("--doors", options.doors, "the doors that the dataset was made with")
      ->needs(share);
  app.add_option("--robot", options.robot,
                 "URDF of the dataset's robot; needed where its config.yaml names a file that is "
                 "not in the dataset's folder")
      ->needs(share);
  PolicyFolders& policies = options.policies;
  app.add_option("--handler", policies.handler, "the policy that turned the handle")->needs(share);
  app.add_option("--opener", policies.opener, "the policy that opened")->needs(share);
  app.add_option("--learner", policies.learner, "the policy that drove or took hold")->needs(share);
}

void CheckRegenerateOptions(const RegenerateOptions& options) {
  ParseFraction(options.share);
  Require(!options.doors.empty(), ErrorCode::kInvalidArgument,
          "--regenerate: needs --doors, with what the dataset was made with");
}

std::vector<DatasetFinding> Regenerate(const fs::path& folder, int threads,
                                       const RegenerateOptions& options) {
  const Stage stage = StageOf(folder);
  const std::string config_file = (folder / "config.yaml").string();
  auto config = LoadConfig<StageConfig>(config_file, {}, DefaultsOf(stage));
  const std::string robot = RecordedRobot(folder, config.scene.robot, options.robot);
  // the config, whose text is compared, goes on naming the file as it did
  std::error_code error;
  Require(robot == config.scene.robot || fs::equivalent(robot, config.scene.robot, error),
          ErrorCode::kInvalidArgument,
          config_file + ": names the robot \"" + config.scene.robot +
              "\", which is another file than --robot " + robot);
  StageRun run({config, options.doors, options.policies, threads});
  RequireSameConfig(folder / "config.yaml", run.Request().config_text);
  const RegenerateResult result = RegenerateEpisodes(
      run.plan(), [&](const PlannedEpisode& planned) { return run.Run(planned); },
      {folder, std::string(NameOf(stage)), ParseFraction(options.share), threads});
  std::fprintf(stderr, "doorforge: %zu episodes made again, %zu differences\n", result.episodes,
               result.findings.size());
  return result.findings;
}

}  // namespace doorforge

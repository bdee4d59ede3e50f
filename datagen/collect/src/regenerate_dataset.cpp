// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/regenerate_dataset.h"

#include "doorforge/collect/stage_run.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

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

}  // namespace

RegenerateResult RegenerateDataset(const RegenerateDatasetRequest& request) {
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
  StageRun run({config, request.doors, request.policies, request.threads, request.robot_meshes});
  RequireSameConfig(config_file, run.Request().config_text);
  return RegenerateEpisodes(
      run.plan(), [&](const PlannedEpisode& planned) { return run.Run(planned); },
      {request.folder, std::string(NameOf(stage)), request.fraction, request.threads});
}

}  // namespace doorforge

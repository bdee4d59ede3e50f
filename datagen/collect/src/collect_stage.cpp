// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/collect_stage.h"

#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/free_space.h"

#include "dataset_folder.h"

namespace doorforge {
namespace {

// Refuses what certainly has no room, and warns where there may be none: episodes have about 16
// decisions where they open, 1 to 25 in general, and clouds and pictures are nearly all of their
// bytes.
void RequireSpaceForShards(const CollectStageRequest& request) {
  constexpr double kBytesAPoint = 13;
  const StageConfig& config = request.stage.config;
  const double decisions = config.stage == Stage::kGrasp ? 1 : 16;
  const double a_decision =
      kBytesAPoint * config.cloud.point_count +
      PictureBytes(config.pictures, CameraOf(config.scene.camera), config.cloud.point_count);
  const double whole =
      static_cast<double>(config.episodes) * decisions * a_decision / request.task.count;
  const double needed = whole - BytesBelow(request.out);
  const std::string lack = LackOfSpace(request.out, needed);
  if (lack.empty()) return;
  const std::string text = lack + "; make room, choose another --out, or ask for fewer --episodes";
  if (!LackOfSpace(request.out, needed / 4).empty()) throw Error(ErrorCode::kIo, text);
  if (request.warn) request.warn(text);
}

}  // namespace

CollectSummary CollectStage(const CollectStageRequest& request) {
  StageRun run(request.stage);
  const FolderLock lock = LockDatasetFolder(request.out, request.replace);
  PrepareDatasetFolder(request.out, request.replace);
  RequireSpaceForShards(request);
  CollectRequest collect = run.Request();
  collect.folder = request.out;
  collect.threads = request.stage.threads;
  collect.task = request.task;
  return Collect(
      run.plan(), [&](const PlannedEpisode& planned) { return run.Run(planned); }, collect);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "doorforge/collect/stage_episode.h"
#include "doorforge/dataset/collect.h"
#include "doorforge/dataset/collection_plan.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/schemas/door_set.h"

namespace doorforge {

/// What a collection is made from, as a user names it.
struct StageRequest {
  StageConfig config;
  std::vector<std::string> doors;  ///< DoorSelectionOf() reads them.
  CollectionWords policies;
  int threads = 0;
  RobotMeshReader robot_meshes;  ///< Reads the meshes of config.scene.robot; see LoadRobot().
  PolicyRegistry registry = BuiltInPolicies();
};

/// A collection of one stage, ready to run: everything that can be refused has been. Not copied,
/// not moved; Run() is thread-safe.
class StageRun {
 public:
  /// @throws Error(kInvalidConfig), Error(kInvalidArgument) if the robot or a policy is not one for
  ///     this stage or no door is left, Error(kMissing or kFormat) as the readers of doors and
  ///     policies.
  explicit StageRun(const StageRequest& request);
  StageRun(const StageRun&) = delete;
  StageRun& operator=(const StageRun&) = delete;

  const StageConfig& config() const { return config_; }
  const CollectionPlan& plan() const { return plan_; }
  /// Those that the stage has a use for: "handle" has none for doors without a latch.
  const std::vector<FoundDoor>& doors() const { return doors_; }

  /// For Collect(): folder, threads and task are the caller's.
  CollectRequest Request() const;
  CollectedEpisode Run(const PlannedEpisode& planned);
  /// Runs the same episode and returns its course, see FilmStageEpisode().
  EpisodeFilm Film(const PlannedEpisode& planned);

 private:
  std::string ConfigText() const;
  void CheckPictureCameras();

  StageConfig config_;
  RobotModel robot_;
  std::unique_ptr<StagePolicies> policies_;
  std::vector<FoundDoor> doors_;
  DoorCache shelf_;
  CollectionPlan plan_;
};

}  // namespace doorforge

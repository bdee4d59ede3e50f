// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "stage_run.h"

#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/rollout/run_episode.h"

#include "robot_meshes.h"

namespace doorforge {
namespace {

RobotModel RobotFor(const StageConfig& config) {
  RobotModel robot =
      LoadRobot(config.scene.robot, RobotBaseNamed(config.scene.physics.base), RobotMeshes());
  Require(HasProprioception(robot), ErrorCode::kInvalidArgument,
          "config.scene: data are recorded for robots with two sliders or a fixed base, seven arm "
          "joints and two fingers; let others open doors with `doorforge simulate`");
  return robot;
}

template <class Pool>
std::unique_ptr<Pool> PoolOf(const std::string& folder, Stage stage, const std::string& role,
                             const CloudConfig& cloud, typename Pool::Load load) {
  if (folder.empty()) return nullptr;
  const TrainedPolicy policy = ReadTrainedPolicy(folder, stage, role);
  Require(policy.cloud_points == 0 || policy.cloud_points == cloud.point_count,
          ErrorCode::kInvalidArgument,
          folder + ": --" + role + " takes clouds of " + std::to_string(policy.cloud_points) +
              " points; config.cloud.point_count is " + std::to_string(cloud.point_count));
  auto pool = std::make_unique<Pool>(policy, load);
  pool->Take();  // weights of another network are refused here, not in the first episode
  return pool;
}

StageConfig Checked(const StageRequest& request) {
  CheckStageConfig(request.config);
  Require(
      request.policies.handler.empty() || request.config.stage == Stage::kGrasp,
      ErrorCode::kInvalidArgument,
      "--handler: belongs to `datagen grasp`, where the handle is turned after the stage that is "
      "recorded");
  Require(
      request.policies.opener.empty() || request.config.stage != Stage::kOpen,
      ErrorCode::kInvalidArgument,
      "--opener: belongs to `datagen handle` and `datagen grasp`, where the door is opened after "
      "the stage that is recorded");
  return request.config;
}

// The folder of the learner if it is one that grasps, or one that does not.
std::string LearnerOf(const StageRequest& request, bool grasps) {
  return (request.config.stage == Stage::kGrasp) == grasps ? request.policies.learner : "";
}

// There is no handle to turn where there is no latch.
DoorFolder WithLatch(const DoorFolder& all) {
  DoorFolder some;
  for (std::size_t i = 0; i < all.doors.size(); ++i) {
    if (all.doors[i].mechanism == NameOf(Mechanism::kNone)) continue;
    some.doors.push_back(all.doors[i]);
    some.paths.push_back(all.paths[i]);
  }
  Require(!some.doors.empty(), ErrorCode::kInvalidArgument,
          "none of the " + std::to_string(all.doors.size()) +
              " doors has a latch; the stage \"handle\" needs handles that turn");
  return some;
}

DoorFolder DoorsFor(const StageRequest& request) {
  DoorFolder doors = ReadDoors(request.doors, request.threads);
  return request.config.stage == Stage::kHandle ? WithLatch(doors) : doors;
}

}  // namespace

StageRun::StageRun(const StageRequest& request)
    : config_(Checked(request)),
      robot_(RobotFor(config_)),
      handler_(PoolOf<PolicyPool>(request.policies.handler, Stage::kHandle, "handler",
                                  config_.cloud, LoadTrainedPolicy)),
      opener_(PoolOf<PolicyPool>(request.policies.opener, Stage::kOpen, "opener", config_.cloud,
                                 LoadTrainedPolicy)),
      learner_(PoolOf<PolicyPool>(LearnerOf(request, false), config_.stage, "learner",
                                  config_.cloud, LoadTrainedPolicy)),
      grasp_learner_(PoolOf<GraspPool>(LearnerOf(request, true), config_.stage, "learner",
                                       config_.cloud, LoadLearnedGrasp)),
      doors_(DoorsFor(request)),
      shelf_(doors_),
      plan_(MakePlan(PartsOf(doors_), config_.episodes, config_.seed, config_.collection)) {}

std::vector<TrainedPolicy> StageRun::Trained() const {
  std::vector<TrainedPolicy> trained;
  for (const PolicyPool* pool : {handler_.get(), opener_.get(), learner_.get()}) {
    if (pool != nullptr) trained.push_back(pool->policy());
  }
  if (grasp_learner_) trained.push_back(grasp_learner_->policy());
  return trained;
}

// The effective config. A comment names what else decides the bytes, so that a run on other doors,
// with another build or another policy is noticed when it is resumed.
std::string StageRun::ConfigText() const {
  std::string text =
      "# doorforge datagen " + std::string(NameOf(config_.stage)) + ", " + CodeVersion() + "\n# " +
      std::to_string(doors_.doors.size()) + " doors, sha256 " + ContentHash(doors_) + "\n# robot " +
      (robot_.name().empty() ? "embedded" : robot_.name() + ", sha256 " + robot_.sha256()) +
      ", rays by " + RayCasterVersion() + "\n";
  for (const TrainedPolicy& policy : Trained())
    text += "# " + TrainedPolicyText(policy) + ", loops for " + PolicyArithmetic() + "\n";
  return text + JsonText(ToJson(config_), 2) + "\n";
}

CollectRequest StageRun::Request() const {
  CollectRequest request;
  request.stage = NameOf(config_.stage);
  request.config_text = ConfigText();
  request.provenance.code_version = CodeVersion();
  request.provenance.compiler = __VERSION__;
  request.provenance.libraries = {{"ray_caster", RayCasterVersion()}};
  for (const TrainedPolicy& policy : Trained())
    request.provenance.policies.push_back(policy.identity);
  request.provenance.seed = config_.seed;
  request.provenance.doors = doors_.doors;
  return request;
}

CollectedEpisode StageRun::Run(const PlannedEpisode& planned) {
  return RunStageEpisode(planned, *shelf_.Take(planned.door), robot_, config_,
                         {handler_.get(), opener_.get(), learner_.get(), grasp_learner_.get()});
}

}  // namespace doorforge

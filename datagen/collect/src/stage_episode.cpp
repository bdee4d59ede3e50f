// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/stage_episode.h"

#include <optional>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/rollout/standing_place.h"

#include "episode_records.h"
#include "recording_camera.h"

namespace doorforge {
namespace {

// Who acted: "expert", "sampled", or the trained policy's hashes; who learned, where somebody did.
nlohmann::ordered_json PoliciesRecord(bool sampled, const TrainedPolicies& trained) {
  const auto actor = [](const auto* pool, const char* untrained = "expert") {
    return pool == nullptr ? nlohmann::ordered_json(untrained)
                           : DatasetPolicyToJson(pool->policy().identity);
  };
  nlohmann::ordered_json record = {
      {"grasp", sampled ? actor(trained.grasp_learner, "sampled") : "expert"},
      {"unlock", actor(trained.handler)},
      {"open", actor(trained.opener)}};
  if (trained.learner != nullptr) record["learner"] = actor(trained.learner);
  return record;
}

Rng StreamOf(const StageConfig& config, const PlannedEpisode& planned, const std::string& name) {
  return {config.seed, "datagen/" + name + "/" + std::to_string(planned.number)};
}

bool SamplesGrasp(const StageConfig& config, const PlannedEpisode& planned) {
  return config.stage == Stage::kGrasp ||
         StreamOf(config, planned, "sampled_grasps").Uniform() < config.sampled_grasps;
}

int LearnerDecisions(const StageConfig& config, const PlannedEpisode& planned) {
  return 1 + static_cast<int>(StreamOf(config, planned, "learner_decisions")
                                  .Index(static_cast<std::uint32_t>(config.learner_decisions)));
}

// The grasp of a trained policy, from the recorded look.
class GraspOfLearner : public GraspChooser {
 public:
  GraspOfLearner(GraspPool& pool, const RobotModel& robot, const CloudExtent& extent,
                 RandomGrasp::Look look)
      : policy_(pool.Take()), clearance_(robot), extent_(extent), look_(std::move(look)) {}

  std::optional<ChosenGrasp> Choose(const SceneSnapshot& snapshot) override {
    return policy_->Choose(
        {look_(snapshot), -snapshot.door[kHandleLink].linear().col(0), clearance_}, extent_);
  }

 private:
  GraspPool::Loan policy_;
  GripperClearance clearance_;
  CloudExtent extent_;
  RandomGrasp::Look look_;
};

// The policies of one episode: lent ones where there are trained ones, rules elsewhere.
class Actors {
 public:
  Actors(const StageConfig& config, const TrainedPolicies& trained)
      : handle_rule_(config.handle), open_rule_(config.expert) {
    if (trained.handler != nullptr) handler_ = trained.handler->Take();
    if (trained.opener != nullptr) opener_ = trained.opener->Take();
    if (trained.learner != nullptr) learner_ = trained.learner->Take();
  }

  Policy* handle() { return handler_ ? handler_.get() : &handle_rule_; }
  Policy* open() { return opener_ ? opener_.get() : &open_rule_; }
  Policy* learner() { return learner_.get(); }

 private:
  HandleExpert handle_rule_;
  OpeningExpert open_rule_;
  PolicyPool::Loan handler_;
  PolicyPool::Loan opener_;
  PolicyPool::Loan learner_;
};

}  // namespace

// The plan of so many episodes takes half a gigabyte.
constexpr std::uint64_t kMostEpisodes = 10'000'000;

StageConfig DefaultsOf(Stage stage) {
  StageConfig config;
  config.stage = stage;
  PhysicsConfig& physics = config.scene.physics;
  switch (stage) {
    case Stage::kOpen:
      physics.max_opening_actions = 30;
      physics.finish_hinge_rad = 1.05;
      physics.action_noise_m = 0.01;
      physics.action_noise_rad = 0.05;
      break;
    case Stage::kHandle:
      // a hand on a locked door cannot give way: more noise would tear it off the handle
      physics.action_noise_m = 0.004;
      physics.action_noise_rad = 0.03;
      config.collection.episodes_per_shard = 512;
      config.learner_decisions = 6;
      break;
    case Stage::kGrasp:
      config.collection.episodes_per_shard = 1024;
      break;
  }
  return config;
}

void CheckStageConfig(const StageConfig& config) {
  Require(config.episodes >= 1 && config.episodes <= kMostEpisodes, ErrorCode::kInvalidConfig,
          "config.episodes: " + std::to_string(config.episodes) + ", expected 1 to " +
              std::to_string(kMostEpisodes) + "; more than that, collect with several seeds");
  Require(config.cloud.point_count >= 1 && config.cloud.point_count <= 1000000,
          ErrorCode::kInvalidConfig, "config.cloud.point_count: out of 1..1000000");
  CheckDepthNoise(config.cloud.noise);
  CheckRandomGrasp(config.grasp);
  CheckGraspLook(config.grasp_look);
  CheckRememberedView(config.remembered);
  Require(config.sampled_grasps >= 0 && config.sampled_grasps <= 1, ErrorCode::kInvalidConfig,
          "config.sampled_grasps: out of 0..1");
  Require(config.learner_decisions >= 1 && config.learner_decisions <= 1000,
          ErrorCode::kInvalidConfig, "config.learner_decisions: out of 1..1000");
  Require(config.scene.physics.max_handle_actions >= 1 &&
              config.scene.physics.max_handle_actions <= 1000,
          ErrorCode::kInvalidConfig, "config.scene.physics.max_handle_actions: out of 1..1000");
}

CollectedEpisode RunStageEpisode(const PlannedEpisode& planned, const DoorAsset& door,
                                 const RobotModel& robot, const StageConfig& config,
                                 const TrainedPolicies& trained) {
  const Scene scene =
      SceneFor(robot, SampleScene(door, config.seed, planned.number, config.scene), door);
  Actors actors(config, trained);
  const bool at_grasp = config.stage == Stage::kGrasp;
  const bool samples_grasp = SamplesGrasp(config, planned);
  const Scene recorded_scene = at_grasp ? SceneOf(config.grasp_look, scene) : scene;
  const double within_m = at_grasp ? config.grasp_look.within_m : 0;
  // the grasp is chosen before the robot stands between camera and handle
  std::optional<RecordingCamera> before;
  if (samples_grasp)
    before.emplace(recorded_scene, door, robot, config.cloud, /*sees_robot=*/false);
  std::optional<RecordingCamera> later;
  if (!at_grasp) later.emplace(scene, door, robot, config.cloud, /*sees_robot=*/true);
  const bool remembers = config.stage == Stage::kHandle && config.remembered.IsOn();
  if (remembers) later->Remember({scene, door, robot, config.cloud, config.remembered});
  RecordingCamera& camera = at_grasp ? *before : *later;
  std::optional<CameraObserver> policies_camera;
  if (at_grasp) {
    policies_camera.emplace(scene, door, robot, config.cloud);
    const RememberedViewConfig of_handler = trained.handler == nullptr
                                                ? RememberedViewConfig{.finer = 0}
                                                : trained.handler->policy().remembered;
    if (of_handler.IsOn())
      policies_camera->Remember({scene, door, robot, config.cloud, of_handler});
  }
  const CloudExtent extent{config.cloud.point_count, within_m};
  const auto look = [&](const SceneSnapshot& snapshot) { return before->LookAtAll(snapshot); };
  RandomGrasp by_chance(scene, door, robot, config.grasp, extent, look);
  GraspChooser* grasp = &by_chance;
  std::optional<GraspOfLearner> learnt;
  if (trained.grasp_learner != nullptr)
    grasp = &learnt.emplace(*trained.grasp_learner, robot, extent, look);
  EpisodeRoles roles{.recorded = config.stage, .open = actors.open()};
  if (config.stage != Stage::kOpen) roles.handle = actors.handle();
  if (samples_grasp) roles.grasp = grasp;
  if (trained.learner != nullptr) {
    roles.learner = actors.learner();
    roles.learner_decisions = LearnerDecisions(config, planned);
  }

  CollectedEpisode collected;
  Observer* observer = &camera;
  if (policies_camera) observer = &*policies_camera;
  collected.episode = RunStages(scene, door, robot, roles, observer);
  const Episode& episode = collected.episode;
  const std::size_t decisions = episode.decisions.size();
  collected.meta = EpisodeMetaToJson(episode);
  collected.meta["stage"] = NameOf(config.stage);
  collected.meta["door"] = DoorRecord(door);
  collected.meta["poses"] = PosesRecord(episode.scene);
  collected.meta["camera"] = CameraRecord(recorded_scene.camera);
  collected.meta["visible_points"] = camera.Visible(decisions);
  collected.meta["hidden"] = camera.OcclusionRecord(decisions);
  collected.meta["policies"] = PoliciesRecord(samples_grasp, trained);
  if (at_grasp) {
    collected.meta["robot_seen"] = false;
    collected.meta["cloud_within_m"] = within_m;
  }
  if (remembers) {
    collected.meta["remembered_finer"] = config.remembered.finer;
    collected.meta["cloud_within_m"] = config.remembered.within_m;
  }
  collected.keep_failed = at_grasp;
  const bool is_kept = episode.outcome == EpisodeOutcome::kOpened || collected.keep_failed;
  if (config.preview && is_kept) collected.preview_png = camera.PreviewPng(decisions);
  return collected;
}

}  // namespace doorforge

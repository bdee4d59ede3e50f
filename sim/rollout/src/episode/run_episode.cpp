// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/run_episode.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/rollout/episode_stepper.h"
#include "doorforge/rollout/expert_grasp.h"
#include "doorforge/rollout/reward.h"

#include "episode/action_noise.h"
#include "episode/episode_recorder.h"

namespace doorforge {
namespace {

// The cloud of a stage is made where it is recorded or somebody looks at it.
std::vector<Stage> CloudsOf(const EpisodePolicies& roles) {
  std::vector<Stage> clouds;
  const auto add = [&](Stage stage, const Policy* policy) {
    if (policy != nullptr && (roles.recorded == stage || policy->UsesPointCloud()))
      clouds.push_back(stage);
  };
  add(Stage::kHandle, roles.handle);
  add(Stage::kOpen, roles.open);
  return clouds;
}

/// Lets the roles play an episode step by step, and records one stage of it.
class Play {
 public:
  Play(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
       const EpisodePolicies& roles)
      : roles_(roles),
        expert_grasp_(scene, door, robot),
        rule_(scene, door),
        noise_(scene),
        recorder_(robot, roles.recorded),
        stepper_(door, robot,
                 {.first = Stage::kGrasp,
                  .turn = roles.handle == nullptr ? &rule_ : nullptr,
                  .handle_turned = roles.handle_turned,
                  .gives_up = roles.gives_up,
                  .grasps = roles.grasps,
                  .clouds = CloudsOf(roles),
                  .bad_action = BadAction::kDiverge}) {}

  Episode Run(const Scene& scene, Observer* observer) {
    stepper_.Reset(scene, observer);
    while (!stepper_.now().over()) {
      if (stepper_.now().stage == Stage::kGrasp) {
        Grasp();
      } else {
        Decide();
      }
    }
    Episode episode = stepper_.Summary();
    if (roles_.recorded == Stage::kGrasp)
      recorder_.RateAll(GraspRating(stepper_.now().observation.privileged));
    episode.decisions = recorder_.Take();
    return episode;
  }

 private:
  void Grasp();
  void Decide();
  void Begin(Policy& policy, Stage stage);
  Action Executed(const Action& action, Stage stage);

  const EpisodePolicies& roles_;
  ExpertGrasp expert_grasp_;
  ExpertUnlock rule_;
  internal::ActionNoise noise_;
  internal::EpisodeRecorder recorder_;
  EpisodeStepper stepper_;
  Stage begun_ = Stage::kGrasp;
  int actions_ = 0;  // of the present stage
};

void Play::Grasp() {
  SnapshotGraspPolicy& chooser = roles_.grasp != nullptr ? *roles_.grasp : expert_grasp_;
  std::optional<GraspCommand> chosen = chooser.Choose(stepper_.Snapshot());
  if (chosen && recorder_.Records(Stage::kGrasp)) {
    Observation seen = stepper_.now().observation;
    seen.cloud = std::move(chosen->cloud);
    const Action action{chosen->contact_m, chosen->world_from_hand_rotation};
    recorder_.Note(seen, action, action, stepper_.state());
  }
  stepper_.Step(roles_.tries ? chosen : std::nullopt);
  begun_ = Stage::kGrasp;
}

void Play::Begin(Policy& policy, Stage stage) {
  policy.Reset();
  if (recorder_.Records(stage) && roles_.learner != nullptr) roles_.learner->Reset();
  begun_ = stage;
  actions_ = 0;
}

// What is recorded is noisy, so that data show how to come back, or a learner's.
Action Play::Executed(const Action& action, Stage stage) {
  if (!recorder_.Records(stage)) return action;
  if (roles_.learner == nullptr || actions_ >= roles_.learner_decisions) return noise_.On(action);
  return roles_.learner->Act(stepper_.now().observation);
}

void Play::Decide() {
  const Stage stage = stepper_.now().stage;
  Policy& policy = stage == Stage::kOpen ? *roles_.open : *roles_.handle;
  if (begun_ != stage) Begin(policy, stage);
  const Observation& seen = stepper_.now().observation;
  const Action action = policy.Act(seen);
  const Action executed = Executed(action, stage);
  if (recorder_.Records(stage)) recorder_.Note(seen, action, executed, stepper_.state());
  const double reward = stepper_.Step(executed).reward;
  if (recorder_.Records(stage)) recorder_.Rate(reward);
  ++actions_;
}

}  // namespace

Episode RunEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                   Policy& opening, Observer* observer) {
  return RunStages(scene, door, robot, {.open = &opening}, observer);
}

Episode RunStages(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const EpisodePolicies& roles, Observer* observer) {
  Require(roles.open != nullptr && (roles.recorded != Stage::kHandle || roles.handle != nullptr) &&
              (roles.recorded != Stage::kGrasp || roles.grasp != nullptr),
          ErrorCode::kInvalidArgument,
          "episode: nobody decides at the stage \"" + std::string(NameOf(roles.recorded)) +
              "\" that is to be recorded, or opens");
  Require(scene.door_id == door.id, ErrorCode::kInvalidArgument,
          "the scene is of door \"" + scene.door_id + "\", not of \"" + door.id + '"');
  return Play(scene, door, robot, roles).Run(scene, observer);
}

}  // namespace doorforge

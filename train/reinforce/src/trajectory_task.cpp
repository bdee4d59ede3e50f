// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/trajectory_task.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/grasp_from_policy.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "drawn_doors.h"

namespace doorforge {
namespace {

/// A grasp drawn at random, and what was seen then.
class SeeingGrasp : public GraspPolicy {
 public:
  SeeingGrasp(const RandomGraspConfig& config, const TrajectoryLook& look)
      : random_(config), look_(look) {}

  std::optional<GraspAction> Choose(const GraspObservation& seen) override {
    sight_ = DoorSightOf(seen, look_);
    if (!sight_) return std::nullopt;
    action_ = random_.Choose(seen);
    return action_;
  }

  const std::optional<DoorSight>& sight() const { return sight_; }
  const GraspAction& action() const { return *action_; }

 private:
  RandomGraspPolicy random_;
  TrajectoryLook look_;
  std::optional<DoorSight> sight_;
  std::optional<GraspAction> action_;
};

/// Rules, and the way of what they tell the hand.
class NotedRule : public Policy {
 public:
  NotedRule(Policy& rule, std::vector<RigidTransform>& way) : rule_(rule), way_(way) {}

  void Reset() override { rule_.Reset(); }
  bool UsesPointCloud() const override { return false; }

  Action Act(const Observation& observation) override {
    const Action action = rule_.Act(observation);
    const RigidTransform& hand = observation.privileged.world_from_hand;
    if (way_.empty()) way_.push_back(hand);
    RigidTransform told = Translation(hand.translation() + action.position_delta_m);
    told.linear() = action.world_from_hand_rotation;
    way_.push_back(told);
    return action;
  }

 private:
  Policy& rule_;
  std::vector<RigidTransform>& way_;
};

/// What was learned so far, and what it said.
class LearnedGrasp : public GraspPolicy {
 public:
  LearnedGrasp(const TrajectoryRater& rater, const TrajectoryTrainingConfig& config)
      : rater_(rater), look_(config.look), choice_(config.choice), replay_(config.choice.actions) {
    choice_.contacts = config.learning.explored_contacts;
    choice_.proposals = config.learning.explored_proposals;
  }

  std::optional<GraspAction> Choose(const GraspObservation& seen) override {
    chosen_ = ChooseTrajectory(rater_, seen, look_, choice_);
    if (!chosen_) return std::nullopt;
    replay_.Begin(chosen_->trajectory);
    GraspAction action;
    action.contact_m = chosen_->target.contact_m.cast<double>();
    action.world_from_hand_rotation = chosen_->trajectory.world_from_hand_rotation;
    return action;
  }

  const std::optional<ChosenTrajectory>& chosen() const { return chosen_; }
  Policy& replay() { return replay_; }

 private:
  const TrajectoryRater& rater_;
  TrajectoryLook look_;
  TrajectoryChoice choice_;
  TrajectoryReplay replay_;
  std::optional<ChosenTrajectory> chosen_;
};

class Lessons {
 public:
  Lessons(const std::vector<FoundDoor>& found, const TrajectoryTrainingConfig& config)
      : config_(config), doors_(found, config.scene, config.learning.seed, "trajectory/door") {}

  std::optional<TrajectoryTrial> Play(std::uint64_t episode, const TrajectoryRater* acts) {
    return acts == nullptr ? ByRules(doors_.At(episode)) : AsLearned(doors_.At(episode), *acts);
  }

 private:
  // The policies at the stages, in a drawn scene, beginning with a look of the closed door.
  Episode Run(const internal::DrawnDoor& drawn, GraspPolicy& grasp, EpisodePolicies roles) const {
    const Scene scene = SceneOf({.resolution_scale = config_.look.finer}, drawn.scene);
    CameraObserver camera(scene, *drawn.door, doors_.robot(), config_.cloud,
                          /*sees_robot=*/false);
    GraspFromPolicy chooser(
        grasp, scene, *drawn.door, doors_.robot(),
        [&](const SceneSnapshot& snapshot) { return camera.Render(snapshot).visible; });
    roles.recorded = Stage::kGrasp;
    roles.grasp = &chooser;
    return RunStages(drawn.scene, *drawn.door, doors_.robot(), roles, nullptr);
  }

  static TrajectoryTrial TrialOf(const Episode& episode) {
    TrajectoryTrial trial;
    if (!episode.decisions.empty())
      trial.opening_rad = static_cast<float>(episode.decisions[0].angle_gain_rad);
    trial.opened = episode.outcome == EpisodeOutcome::kOpened;
    return trial;
  }

  std::optional<TrajectoryTrial> ByRules(const internal::DrawnDoor& drawn) const {
    SeeingGrasp grasp(config_.grasp, config_.look);
    std::vector<RigidTransform> way;
    HandleExpert turns;
    OpeningExpert opens;
    NotedRule handle(turns, way);
    NotedRule open(opens, way);
    TrajectoryTrial trial = TrialOf(Run(drawn, grasp, {.handle = &handle, .open = &open}));
    if (!grasp.sight()) return std::nullopt;
    trial.sight = *grasp.sight();
    trial.contact_m = grasp.action().contact_m.cast<float>();
    trial.moved = way.size() > 1;
    if (!trial.moved) way.assign(1, RigidTransform::Identity());
    trial.numbers = ToNumbers(
        {grasp.action().world_from_hand_rotation, EvenWaypoints(way, config_.network.waypoints)});
    return trial;
  }

  std::optional<TrajectoryTrial> AsLearned(const internal::DrawnDoor& drawn,
                                           const TrajectoryRater& rater) const {
    LearnedGrasp grasp(rater, config_);
    TrajectoryTrial trial =
        TrialOf(Run(drawn, grasp, {.handle = &grasp.replay(), .open = &grasp.replay()}));
    if (!grasp.chosen()) return std::nullopt;
    trial.sight = grasp.chosen()->sight;
    trial.contact_m = grasp.chosen()->target.contact_m;
    trial.numbers = ToNumbers(grasp.chosen()->trajectory);
    return trial;
  }

  TrajectoryTrainingConfig config_;
  internal::DrawnDoors doors_;
};

}  // namespace

void CheckTrajectoryTraining(const TrajectoryTrainingConfig& config) {
  CheckRandomGrasp(config.grasp);
  CheckTrajectoryLook(config.look, "config.look");
  CheckTrajectoryShape(config.network, "config.network");
  CheckTrajectoryChoice(config.choice, "config.choice");
  CheckTrajectoryLearning(config.learning, "config.learning");
  Require(config.scene.physics.base != RobotBase::kFloating, ErrorCode::kInvalidConfig,
          "config.scene.physics.base: a trajectory is carried out by an arm, on any base that "
          "stands or drives; found floating");
}

TrajectoryTask TrajectoryLessons(const std::vector<FoundDoor>& doors,
                                 const TrajectoryTrainingConfig& config) {
  CheckTrajectoryTraining(config);
  const auto lessons = std::make_shared<Lessons>(doors, config);
  return {config.look.points(), [lessons](std::uint64_t episode, const TrajectoryRater* acts) {
            return lessons->Play(episode, acts);
          }};
}

}  // namespace doorforge

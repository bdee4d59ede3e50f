// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/episode_stepper.h"

#include <utility>

#include "doorforge/core/error.h"

#include "episode/action_check.h"
#include "episode/running_episode.h"

namespace doorforge {

EpisodeStepper::EpisodeStepper(const DoorAsset& door, const RobotModel& robot,
                               StepperOptions options)
    : door_(&door), robot_(&robot), options_(std::move(options)) {}
EpisodeStepper::~EpisodeStepper() = default;
EpisodeStepper::EpisodeStepper(EpisodeStepper&&) noexcept = default;
EpisodeStepper& EpisodeStepper::operator=(EpisodeStepper&&) noexcept = default;

Observation EpisodeStepper::Reset(const Scene& scene, Observer* observer) {
  Require(scene.door_id == door_->id, ErrorCode::kInvalidArgument,
          "the scene is of door \"" + scene.door_id + "\", not of \"" + door_->id + '"');
  CheckEpisodeLimits(scene.limits, "scene.limits");
  running_.reset();
  running_ = std::make_unique<Running>(scene, *door_, *robot_, options_, observer);
  running_->PlayToTheCallersFirst();
  return running_->now().observation;
}

EpisodeStepper::Running& EpisodeStepper::Live() const {
  Require(running_ != nullptr, ErrorCode::kInvalidArgument,
          "episode: there is none yet; call Reset() with a scene first");
  return *running_;
}

EpisodeStepper::Running& EpisodeStepper::Playing(const std::string& what) const {
  Running& running = Live();
  if (running.course().over())
    throw Error(ErrorCode::kInvalidArgument,
                what + ": the episode is over (" + std::string(NameOf(running.course().outcome())) +
                    "); call Reset() with a scene, or Restore() an earlier point");
  return running;
}

const StepResult& EpisodeStepper::Step(const Action& action) {
  Running& running = Playing("action");
  if (running.bad_action() == BadAction::kRefuse) internal::CheckAction(action, "action");
  if (running.course().stage() == Stage::kGrasp) {
    GraspCommand grasp;
    grasp.contact_m = action.position_delta_m;
    grasp.world_from_hand_rotation = action.world_from_hand_rotation;
    running.Grasp(std::move(grasp));
  } else {
    running.Act(action);
  }
  return running.now();
}

const StepResult& EpisodeStepper::Step(const std::optional<GraspCommand>& grasp) {
  Running& running = Playing("grasp");
  Require(running.course().stage() == Stage::kGrasp, ErrorCode::kInvalidArgument,
          "grasp: the hand holds the handle already; from here on Step() takes actions");
  if (grasp && running.bad_action() == BadAction::kRefuse) internal::CheckGrasp(*grasp);
  running.Grasp(grasp);
  return running.now();
}

const StepResult& EpisodeStepper::now() const { return Live().now(); }
const WorldState& EpisodeStepper::state() const { return Live().world().state(); }
SceneSnapshot EpisodeStepper::Snapshot() const {
  return Live().world().Snapshot(EpisodePhase::kStart);
}
Episode EpisodeStepper::Summary() const { return Live().course().Summary(); }

EpisodeImage EpisodeStepper::Save() const {
  EpisodeImage image;
  image.content_ = std::make_shared<const EpisodeImage::Content>(Live().Save());
  return image;
}

const StepResult& EpisodeStepper::Restore(const EpisodeImage& image) {
  Require(image.content_ != nullptr, ErrorCode::kInvalidArgument,
          "the image is empty; take one with Save() first");
  Live().Restore(*image.content_);
  return now();
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/running_episode.h"

#include <algorithm>
#include <utility>

#include "doorforge/rollout/expert_grasp.h"
#include "doorforge/rollout/proprioception.h"
#include "doorforge/rollout/reward.h"

namespace doorforge {

void EpisodeStepper::Running::PlayToTheCallersFirst() {
  if (options_.first != Stage::kGrasp) {
    ExpertGrasp expert(world_.scene(), door_, world_.robot());
    SnapshotGraspPolicy& chooser = options_.grasp != nullptr ? *options_.grasp : expert;
    course_.Grasp(chooser.Choose(world_.Snapshot(EpisodePhase::kStart)));
    if (!course_.over()) BeginTurn();
    PlayOthers();
  }
  Settle(0);
}

// Where opening is the caller's first stage, a rule turns the handle unless somebody else does.
void EpisodeStepper::Running::BeginTurn() {
  if (options_.turn != nullptr) return course_.Turn(*options_.turn);
  if (options_.first != Stage::kOpen || options_.handle != nullptr) return course_.BeginTurn();
  ExpertUnlock rule(world_.scene(), door_);
  course_.Turn(rule);
}

void EpisodeStepper::Running::PlayOthers() {
  Stage begun = Stage::kGrasp;
  while (!course_.over()) {
    const Stage stage = course_.stage();
    Policy* policy = stage == Stage::kHandle ? options_.handle : options_.open;
    if (policy == nullptr || stage == Stage::kGrasp) return;
    if (begun != stage) policy->Reset();
    begun = stage;
    course_.Act(policy->Act(Observe()));
  }
}

void EpisodeStepper::Running::Settle(double reward) {
  now_ = StepResult();
  now_.stage = course_.stage();
  now_.reward = reward;
  now_.terminated = course_.over() && !course_.truncated();
  now_.truncated = course_.over() && course_.truncated();
  if (course_.over()) now_.cause = course_.outcome();
  now_.observation = Observe();
}

void EpisodeStepper::Running::Grasp(std::optional<GraspCommand> grasp) {
  course_.Grasp(std::move(grasp));
  if (!course_.over()) BeginTurn();
  PlayOthers();
  Settle(GraspRating(world_.Privileged()));
}

void EpisodeStepper::Running::Act(const Action& action) {
  const double reward = course_.Act(action);
  PlayOthers();
  Settle(reward);
}

// The place where somebody looks: before each decision, and never where nobody asked for a cloud.
Observation EpisodeStepper::Running::Observe() const {
  const Stage stage = course_.stage();
  const EpisodePhase phase = stage == Stage::kOpen     ? EpisodePhase::kOpen
                             : stage == Stage::kHandle ? EpisodePhase::kUnlock
                                                       : EpisodePhase::kStart;
  Observation observation;
  if (!course_.over()) {
    if (stage != Stage::kGrasp) world_.Watch(phase);
    const auto& clouds = options_.clouds;
    const bool looks = std::find(clouds.begin(), clouds.end(), stage) != clouds.end();
    if (looks && world_.observer() != nullptr)
      observation.cloud = world_.observer()->Observe(world_.Snapshot(phase));
  }
  if (HasProprioception(world_.robot()))
    observation.proprioception =
        ProprioceptionOf(world_.robot(), world_.state(), world_.scene().world_from_robot_base);
  observation.privileged = world_.Privileged();
  return observation;
}

EpisodeImage::Content EpisodeStepper::Running::Save() const {
  const Observer* observer = world_.observer();
  return {world_.SaveWorld(), world_.memory(), course_.state(), now_,
          observer != nullptr ? observer->Save() : std::any()};
}

void EpisodeStepper::Running::Restore(const EpisodeImage::Content& image) {
  world_.Restore(image.world, image.memory);
  course_.Restore(image.course);
  now_ = image.now;
  if (world_.observer() != nullptr) world_.observer()->Restore(image.observer);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <any>
#include <optional>

#include "doorforge/rollout/episode_stepper.h"

#include "episode/episode_course.h"
#include "episode/episode_world.h"

namespace doorforge {

struct EpisodeImage::Content {
  WorldImage world;
  internal::EpisodeWorld::Memory memory;
  internal::EpisodeCourse::State course;
  StepResult now;
  std::any observer;
};

/// One episode with those who act in it besides the caller.
class EpisodeStepper::Running {
 public:
  Running(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
          const StepperOptions& options, Observer* observer)
      : options_(options),
        door_(ApplyVariation(door, scene.variation)),
        world_(scene, door_, robot, observer),
        course_(world_, options.handle_turned, options.gives_up, options.grasps) {
    world_.Watch(EpisodePhase::kStart);
  }

  void PlayToTheCallersFirst();
  void Grasp(std::optional<GraspCommand> grasp);
  void Act(const Action& action);

  const internal::EpisodeWorld& world() const { return world_; }
  const internal::EpisodeCourse& course() const { return course_; }
  const StepResult& now() const { return now_; }
  const BadAction& bad_action() const { return options_.bad_action; }
  EpisodeImage::Content Save() const;
  void Restore(const EpisodeImage::Content& image);

 private:
  void BeginTurn();
  void PlayOthers();
  void Settle(double reward);
  Observation Observe() const;

  StepperOptions options_;
  DoorAsset door_;
  internal::EpisodeWorld world_;
  internal::EpisodeCourse course_;
  StepResult now_;
};

}  // namespace doorforge

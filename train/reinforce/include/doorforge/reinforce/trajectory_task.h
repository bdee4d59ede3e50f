// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/trajectory_policy.h"
#include "doorforge/rollout/random_grasp.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/sensor/point_cloud.h"
#include "doorforge/training/trajectories.h"

namespace doorforge {

/// Settings of a training of a policy that says whole trajectories. Its episodes go on until the
/// door is open by `scene.physics.finish_hinge_rad`, 55 degrees by default: what is asked for later
/// is to be more than what counts as open.
struct TrajectoryTrainingConfig {
  TrajectoryTrainingConfig() { scene.physics.finish_hinge_rad = 0.96; }

  SceneConfig scene;
  CloudConfig cloud;
  RandomGraspConfig grasp;  ///< Of the rules' episodes.
  TrajectoryLook look;
  TrajectoryShape network;
  TrajectoryChoice choice;
  TrajectoryLearning learning;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("scene", self.scene);
    visit("cloud", self.cloud);
    visit("grasp", self.grasp);
    visit("look", self.look);
    visit("network", self.network);
    visit("choice", self.choice);
    visit("learning", self.learning);
  }
};

/// Throws Error(kInvalidConfig) on a number out of its range.
void CheckTrajectoryTraining(const TrajectoryTrainingConfig& config);

/// Doors to learn on, as a task for TrainTrajectories(). Episode n draws a category, then one of
/// its doors, from the stream "trajectory/door/<n>" of learning.seed, and has the scene that
/// SampleScene() gives for this seed and number.
///
/// Rules take hold as RandomGraspPolicy does and act as HandleExpert and OpeningExpert do; their
/// trajectory is the way of what they told the hand, in EvenWaypoints(). What was learned acts as
/// the policy will, with the contacts and proposals of `learning`.
///
/// @param doors Must outlive the task.
/// @throws Error(kInvalidArgument) without doors; Error(kInvalidConfig) as
///     CheckTrajectoryTraining(), and on a robot that is not the built-in one or that flies.
TrajectoryTask TrajectoryLessons(const std::vector<FoundDoor>& doors,
                                 const TrajectoryTrainingConfig& config);

}  // namespace doorforge

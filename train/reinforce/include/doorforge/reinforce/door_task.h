// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/frozen_sight.h"
#include "doorforge/reinforce/hand_reward.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/hand_policy.h"
#include "doorforge/sensor/point_cloud.h"
#include "doorforge/training/ppo.h"

namespace doorforge {

/// Settings of a training of a hand on doors.
struct HandTrainingConfig {
  SceneConfig scene;
  CloudConfig cloud;  ///< A hand that acts on states sees none.
  HandTaskConfig task;
  HandRewardConfig reward;
  PpoConfig ppo;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("scene", self.scene);
    visit("cloud", self.cloud);
    visit("task", self.task);
    visit("reward", self.reward);
    visit("ppo", self.ppo);
  }
};

/// Doors to learn on, as a task for TrainPpo(). An episode is a pure function of its number: it
/// draws a category, then one of its doors, from the stream "ppo/door/<number>" of ppo.seed, and
/// the scene that SampleScene() gives for this seed and number. Observations are HandFeaturesOf(),
/// actions HandCommandOf(), rewards HandReward(); an episode ends with its budget, or where the
/// physics became impossible, and not with success.
///
/// @param doors Must outlive the task and its steppers.
/// @param sight Not null: observations are its numbers of what the camera sees, with the hand in
///     it, sampled as it looks. Rewards are of the true states all the same.
/// @throws Error(kInvalidArgument) without doors; Error(kInvalidConfig) as CheckHandTask(),
///     CheckPpoConfig() and HandStepper, and on a robot that is not the built-in one.
PpoTask DoorTask(const std::vector<FoundDoor>& doors, const HandTrainingConfig& config,
                 std::shared_ptr<const FrozenSight> sight = nullptr);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/hand_policy.h"
#include "doorforge/sensor/point_cloud.h"
#include "doorforge/training/dagger.h"

namespace doorforge {

/// Settings of a training of a hand that looks, from one that knows the true states. How it is led
/// and where it begins is the teacher's.
struct DistilConfig {
  SceneConfig scene;
  CloudConfig cloud;
  HandLook look;
  DaggerConfig dagger;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("scene", self.scene);
    visit("cloud", self.cloud);
    visit("look", self.look);
    visit("dagger", self.dagger);
  }
};

/// Doors to learn on, as a task for TrainDagger(). Episode n draws a category, then one of its
/// doors, from the stream "dagger/door/<n>" of dagger.seed, and has the scene that SampleScene()
/// gives for this seed and number. It is judged, and ends, as an episode of an evaluation does.
/// What is seen is the camera's cloud with the hand in it, sampled as config.look says; what is
/// taught the mean action of the teacher, clipped to [-1, 1].
///
/// @throws Error(kInvalidArgument) without doors; Error(kInvalidConfig) as CheckDaggerConfig(),
///     CheckHandLook() and HandStepper, and on a robot that is not the built-in one.
DaggerTask DistilTask(const std::vector<FoundDoor>& doors, const HandPolicyRecord& teacher,
                      const DistilConfig& config);

}  // namespace doorforge

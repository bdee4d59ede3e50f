// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/registry/policy_registry.h"
#include "doorforge/registry/policy_set_factory.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// Everything that decides an evaluation's result besides policy and doors.
struct EvaluationConfig {
  int seeds = 3;                 ///< >= 1; UniDoorManip repeats over 3.
  std::uint64_t first_seed = 1;  ///< The seeds are first_seed, first_seed + 1, ...
  int episodes_per_door = 1;     ///< In each seed, >= 1.
  bool expert_reference = true;  ///< The expert opens the same scenes, too.
  /// Who ends the turning of the handle where a trained policy turns it. A rule and a policy of
  /// one's own have the simulator's answer.
  SwitchSource unlock_switch = SwitchSource::kPolicy;
  PolicyOptions policy;
  GraspOptions grasp;              ///< A trained grasper has them.
  RandomGraspConfig random_grasp;  ///< The grasper "random" has it.
  int grasp_look_finer =
      GraspCameraConfig{}
          .resolution_scale;  ///< GraspCameraConfig::resolution_scale of a trained grasper.
  int grasps = 1;             ///< So many times the hand may take hold in an episode, 1 to 10.
  SceneConfig scene;
  CloudConfig cloud;  ///< It must be that of the data set that the policy was trained from.

  /// What its policies are made with.
  PolicySettings Policies() const {
    return {.network = policy,
            .network_grasp = grasp,
            .network_grasp_resolution = grasp_look_finer,
            .grasps = grasps,
            .random_grasp = random_grasp};
  }

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("seeds", self.seeds);
    visit("first_seed", self.first_seed);
    visit("episodes_per_door", self.episodes_per_door);
    visit("expert_reference", self.expert_reference);
    visit("switch", self.unlock_switch);
    visit("policy", self.policy);
    visit("grasp", self.grasp);
    visit("random_grasp", self.random_grasp);
    visit("grasp_look_finer", self.grasp_look_finer);
    visit("grasps", self.grasps);
    visit("scene", self.scene);
    visit("cloud", self.cloud);
  }
};

}  // namespace doorforge

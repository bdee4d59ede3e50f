// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/action_noise.h"

#include <cmath>
#include <string>

namespace doorforge::internal {

ActionNoise::ActionNoise(const Scene& scene)
    : spread_m_(scene.physics.action_noise_m),
      spread_rad_(scene.physics.action_noise_rad),
      rng_(scene.seed,
           "episode/" + scene.door_id + "/" + std::to_string(scene.episode) + "/actions") {}

Action ActionNoise::On(const Action& action) {
  if (spread_m_ == 0 && spread_rad_ == 0) return action;
  if (!bias_) {
    bias_.emplace();
    for (double& bias : *bias_) bias = rng_.Normal();
  }
  std::array<double, 6> noise{};
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = std::sqrt(0.5) * ((*bias_)[i] + rng_.Normal());
  const Eigen::Vector3d turn = spread_rad_ * Eigen::Vector3d(noise[3], noise[4], noise[5]);
  Action noisy = action;
  noisy.position_delta_m += spread_m_ * Eigen::Vector3d(noise[0], noise[1], noise[2]);
  if (turn.norm() > 0)
    noisy.world_from_hand_rotation =
        RotationAbout(turn.normalized(), turn.norm()).linear() * action.world_from_hand_rotation;
  return noisy;
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "doorforge/core/rng.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge::internal {

/// The noise of PhysicsConfig::action_noise_m and action_noise_rad on the actions of one episode,
/// from the stream "episode/<door id>/<episode>/actions" of the scene's seed. Half of it is a bias
/// that stays for the episode: a trained policy errs that way.
class ActionNoise {
 public:
  explicit ActionNoise(const Scene& scene);

  Action On(const Action& action);

 private:
  double spread_m_;
  double spread_rad_;
  Rng rng_;
  std::optional<std::array<double, 6>> bias_;
};

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/hand_policy.h"

#include "doorforge/core/config_io.h"

namespace doorforge {

void CheckHandTask(const HandTaskConfig& config, const std::string& path) {
  RequireRange(path, "steps_per_action", config.steps_per_action, 1, 240);
  RequireRange(path, "max_actions", config.max_actions, 1, 10000);
  RequireRange(path, "start_distance_m", config.start_distance_m, 0, 0.5);
  RequireRange(path, "start_spread_m", config.start_spread_m, 0, 0.2);
  RequireRange(path, "start_turn_rad", config.start_turn_rad, 0, 1.5);
  RequireRange(path, "move_m", config.move_m, 0.001, 0.2);
  RequireRange(path, "turn_rad", config.turn_rad, 0.001, 1);
}

void CheckHandLook(const HandLook& look, const std::string& path) {
  RequireRange(path, "points", look.points, 16, 16384);
  RequireRange(path, "crop_radius_m", look.crop_radius_m, 0, 10);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/train_config.h"

namespace doorforge {

TrainConfig TrainDefaultsOf(std::string_view stage) {
  TrainConfig config;
  config.family = FamilyOf(stage);
  if (config.family != NetworkFamily::kFind) return config;
  config.epochs = 2;
  config.discriminator_epochs = 8;
  config.sampled_points = 1024;
  config.crop_radius_m = 0.2;
  config.point_scale = 6;
  config.augment_mirror = true;
  config.augment_roll_rad = 0.2;
  return config;
}

}  // namespace doorforge

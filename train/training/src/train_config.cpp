// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/training/train_stage.h"

#include "device_encoder.h"
#include "stage_task.h"

namespace doorforge {
namespace {

void RequireConfig(bool condition, const char* key, const char* allowed) {
  if (!condition)
    throw Error(ErrorCode::kInvalidConfig, std::string("config.") + key + ": must be " + allowed);
}

double LearningRateInPhase(const TrainConfig& config, std::uint64_t step, std::uint64_t total) {
  const double warmup = config.warmup_steps > 0
                            ? std::min(1.0, static_cast<double>(step + 1) / config.warmup_steps)
                            : 1.0;
  const auto s = static_cast<double>(step);
  double decay = 1;
  if (config.schedule == RateSchedule::kCosine)
    decay = 0.01 + 0.99 * 0.5 * (1 + std::cos(std::numbers::pi * s / static_cast<double>(total)));
  if (config.schedule == RateSchedule::kStep) decay = std::pow(0.9, std::floor(s / 5000));
  return config.learning_rate * warmup * decay;
}

}  // namespace

void CheckTrainConfig(const TrainConfig& config) {
  RequireConfig(config.epochs >= 1, "epochs", "at least 1");
  RequireConfig(config.discriminator_epochs >= 0, "discriminator_epochs", "at least 0");
  RequireConfig(config.batch_size >= 1, "batch_size", "at least 1");
  RequireConfig(config.learning_rate > 0, "learning_rate", "positive");
  RequireConfig(config.weight_decay >= 0, "weight_decay", "at least 0");
  RequireConfig(config.warmup_steps >= 0, "warmup_steps", "at least 0");
  RequireConfig(config.lambda_position >= 0 && config.lambda_rotation >= 0 &&
                    config.lambda_kl >= 0 && config.prior_reconstruction >= 0,
                "lambda_*", "at least 0");
  RequireConfig(config.augment_roll_rad >= 0 && config.augment_roll_rad <= std::numbers::pi,
                "augment_roll_rad", "in [0, pi]");
  RequireConfig(
      config.frame == ViewFrame::kHand || (config.augment_roll_rad == 0 && !config.augment_mirror),
      "augment_roll_rad and augment_mirror", "0 and false in the frame \"world\"");
  RequireConfig(config.family == NetworkFamily::kGrasp || config.state != StateKind::kJoints ||
                    !config.augment_mirror,
                "augment_mirror",
                "false with the state \"joints\": the mirror image of an arm is another arm");
  RequireConfig(config.point_scale > 0 && config.point_scale <= 100, "zoom", "in (0, 100]");
  RequireConfig(config.crop_radius_m >= 0 && config.crop_radius_m < 100, "context_m",
                "in [0, 100)");
  internal::RequireDevice(config.device);
  RequireConfig(config.critic_interval >= 1, "critic_interval", "at least 1");
  RequireConfig(config.sampled_points >= 1 && config.sampled_points <= kCloudPoints,
                "sampled_points", "1 to 4096");
  RequireConfig(config.near_points >= 0 && config.near_points <= kCloudPoints, "near_points",
                "0 to 4096");
  RequireConfig(config.sampled_orientations >= 1 && config.sampled_orientations <= 10000,
                "sampled_orientations", "1 to 10000");
  RequireConfig(
      config.best_orientations >= 1 && config.best_orientations <= config.sampled_orientations,
      "best_orientations", "1 to sampled_orientations");
  RequireConfig(config.tilt_rad >= 0 && config.tilt_rad < 1, "tilt_rad", "in [0, 1)");
  RequireConfig(config.validation_share >= 0 && config.validation_share < 1, "validation_share",
                "in [0, 1)");
}

std::uint64_t StepsPerEpoch(std::size_t samples, const TrainConfig& config) {
  return samples == 0 ? 0 : samples / internal::BatchSize(samples, config);
}

int EpochsOf(const TrainConfig& config) {
  int epochs = 0;
  for (int phase = 0; phase < internal::PhasesOf(config.family); ++phase)
    epochs += internal::EpochsOfPhase(config, phase);
  return epochs;
}

double LearningRateAt(const TrainConfig& config, TrainingPlace place) {
  std::uint64_t begin = 0;
  for (int phase = 0; phase < internal::PhasesOf(config.family); ++phase) {
    const std::uint64_t steps =
        place.steps_per_epoch * static_cast<std::uint64_t>(internal::EpochsOfPhase(config, phase));
    if (place.step < begin + steps) return LearningRateInPhase(config, place.step - begin, steps);
    begin += steps;
  }
  return 0;
}

std::vector<LossColumn> LossColumnsOf(NetworkFamily family) {
  if (family == NetworkFamily::kFind)
    return {{"mask.cross_entropy", &StageLosses::mask},
            {"place.cross_entropy", &StageLosses::place}};
  if (family == NetworkFamily::kGrasp)
    return {{"discriminator.score_rad", &StageLosses::angle_gain_rad},
            {"affordance.score_rad", &StageLosses::affordance_rad}};
  return {{"actor.position_m", &StageLosses::position_m},
          {"actor.rotation_rad", &StageLosses::rotation_rad},
          {"actor.divergence", &StageLosses::divergence},
          {"critic.score_rad", &StageLosses::angle_gain_rad}};
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "best_networks.h"

#include <limits>
#include <optional>

namespace doorforge::internal {
namespace {

std::optional<double> ActorError(const StageLosses& losses, const TrainConfig& config) {
  if (config.family == NetworkFamily::kFind) return losses.place;
  if (config.family == NetworkFamily::kGrasp) return losses.affordance_rad;
  if (!losses.position_m || !losses.rotation_rad) return std::nullopt;
  return config.lambda_position * *losses.position_m +
         config.lambda_rotation * *losses.rotation_rad;
}

std::optional<double> CriticError(const StageLosses& losses, const TrainConfig& config) {
  return config.family == NetworkFamily::kFind ? losses.mask : losses.angle_gain_rad;
}

// From 1, the first of equals; 0 without a number.
int BestEpoch(const TrainerState& state, const TrainConfig& config,
              std::optional<double> (*error_of)(const StageLosses&, const TrainConfig&)) {
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < state.epochs.size(); ++e) {
    const std::optional<double> error = error_of(state.epochs[e].validation, config);
    if (!error || !(*error < least)) continue;
    least = *error;
    best = static_cast<int>(e) + 1;
  }
  return best;
}

}  // namespace

void UpdateBest(const TrainConfig& config, TrainerState& state) {
  const auto now = static_cast<int>(state.epochs.size());
  const BestEpochs epochs{BestEpoch(state, config, ActorError),
                          BestEpoch(state, config, CriticError)};
  if (epochs.actor != now && epochs.critic != now) return;
  StageNetworks policy = PolicyOf(state);
  if (epochs.actor != now) policy.actor = std::move(state.best.networks.actor);
  if (epochs.critic != now) policy.critic = std::move(state.best.networks.critic);
  state.best = {epochs, std::move(policy)};
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/training/ppo.h"

namespace doorforge::internal {

/// Decisions to learn from, row by row.
struct PpoBatch {
  std::vector<float> observations;
  std::vector<float> actions;
  std::vector<float> log_probabilities;  ///< Of the action when it was taken.
  std::vector<float> values;             ///< By the critic of then.
  std::vector<float> advantages;         ///< Normalised over the update.
  std::vector<float> returns;            ///< Advantage, not normalised, plus value.

  std::size_t size() const { return values.size(); }
};

/// Log of the density of an action under the normal distribution of these means and spreads.
double LogProbability(std::span<const float> action, std::span<const float> mean,
                      std::span<const float> log_deviation);

struct PpoLoss {
  double policy = 0;
  double value = 0;
  double entropy = 0;
  double kl = 0;
  double clipped = 0;
  /// The gradient is that of policy + config.value * value - config.entropy * entropy, by the
  /// parameters of actor, spread and critic, one after the other.
  std::vector<float> gradient;
};

/// With r = exp(log p - log p then) and A the advantage, the means over the batch of
///   policy:  -min(r A, clamp(r, 1 - clip, 1 + clip) A)
///   value:   max((v - R)^2, (v then + clamp(v - v then, -c, c) - R)^2) / 2 with c = value_clip;
///            without one, (v - R)^2 / 2
///   entropy: sum of log deviation + log(2 pi e) / 2
///   kl:      (r - 1) - log r
/// and the share of |r - 1| > clip. In libtorch, single precision.
PpoLoss PpoLossOf(const PpoNetworks& networks, const PpoBatch& batch, const PpoConfig& config);

}  // namespace doorforge::internal

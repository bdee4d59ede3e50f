// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "sharded_step.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"

#include "adam.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kShard = 16;  // rows whose gradient one thread computes at a time

void CutTo(double most, std::span<float> gradient) {
  double squares = 0;
  for (const float g : gradient) squares += double{g} * double{g};
  const double norm = std::sqrt(squares);
  if (norm <= most) return;
  for (float& g : gradient) g = static_cast<float>(double{g} * (most / norm));
}

}  // namespace

double ShardedStep(std::span<const std::size_t> rows, const LossOfRows& loss,
                   const StepRates& rates, const AdamState& state) {
  const std::size_t shards = (rows.size() + kShard - 1) / kShard;
  std::vector<std::vector<float>> gradients(shards);
  std::vector<double> losses(shards);
  ParallelFor(shards, rates.threads, [&](std::size_t i) {
    gradients[i].resize(state.parameters.size());
    losses[i] =
        loss(rows.subspan(i * kShard, std::min(kShard, rows.size() - i * kShard)), gradients[i]);
  });
  for (std::size_t i = 1; i < shards; ++i) {
    losses[0] += losses[i];
    for (std::size_t k = 0; k < gradients[0].size(); ++k) gradients[0][k] += gradients[i][k];
  }
  Require(std::isfinite(losses[0]), ErrorCode::kIncomplete,
          "training: a loss is not finite; the last round is kept");
  CutTo(rates.gradient_norm, gradients[0]);
  ++state.steps;
  AdamStep({rates.learning_rate, rates.weight_decay}, state.steps, gradients[0],
           {state.parameters, state.first_moment, state.second_moment});
  return losses[0];
}

}  // namespace doorforge::internal

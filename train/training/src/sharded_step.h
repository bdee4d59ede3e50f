// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

// A step of the gradient whose bytes do not depend on the number of threads.

namespace doorforge::internal {

/// Parameters on their way, with Adam's memory of them.
struct AdamState {
  std::vector<float>& parameters;
  std::vector<float>& first_moment;
  std::vector<float>& second_moment;
  std::uint64_t& steps;
};

struct StepRates {
  double learning_rate = 1e-3;
  double gradient_norm = 1;  ///< A longer gradient is cut to this.
  double weight_decay = 0;
  int threads = 0;
};

/// Sum of the losses of some of a minibatch's rows; adds its gradient to the last argument.
using LossOfRows = std::function<double(std::span<const std::size_t>, std::span<float>)>;

/// The minibatch is cut into shards of 16 rows, whose gradients any thread computes and which are
/// summed in their order; then one step of Adam. Returns the sum of the losses.
///
/// @throws Error(kIncomplete) where that is not finite, before anything has changed.
double ShardedStep(std::span<const std::size_t> rows, const LossOfRows& loss,
                   const StepRates& rates, const AdamState& state);

}  // namespace doorforge::internal

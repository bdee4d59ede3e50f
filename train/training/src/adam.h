// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace doorforge::internal {

struct AdamRates {
  double learning_rate;
  double weight_decay;
};

/// What a step changes, all of equal length.
struct AdamSlot {
  std::span<float> parameters;
  std::span<float> first;   ///< Moment of the gradient.
  std::span<float> second;  ///< Moment of its square.
};

/// One step of Adam (Kingma and Ba 2015; betas 0.9 and 0.999, epsilon 1e-8, decay added to the
/// gradient as PyTorch's Adam does). `step` counts from 1.
void AdamStep(const AdamRates& rates, std::uint64_t step, std::span<const float> gradient,
              const AdamSlot& slot);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "adam.h"

#include <cmath>

namespace doorforge::internal {

void AdamStep(const AdamRates& rates, std::uint64_t step, std::span<const float> gradient,
              const AdamSlot& slot) {
  constexpr float kBeta1 = 0.9F;
  constexpr float kBeta2 = 0.999F;
  constexpr float kEpsilon = 1e-8F;
  const auto t = static_cast<double>(step);
  const auto rate = static_cast<float>(rates.learning_rate / (1 - std::pow(0.9, t)));
  const auto correction = static_cast<float>(1 / std::sqrt(1 - std::pow(0.999, t)));
  const auto decay = static_cast<float>(rates.weight_decay);
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    const float g = gradient[i] + decay * slot.parameters[i];
    slot.first[i] = kBeta1 * slot.first[i] + (1 - kBeta1) * g;
    slot.second[i] = kBeta2 * slot.second[i] + (1 - kBeta2) * g * g;
    slot.parameters[i] -=
        rate * slot.first[i] / (std::sqrt(slot.second[i]) * correction + kEpsilon);
  }
}

}  // namespace doorforge::internal

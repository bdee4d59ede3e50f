// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "doorforge/networks/instruction_set.h"

namespace doorforge::testing {

/// Where clouds are moved before an encoder reads them [m].
inline constexpr std::array<float, 3> kCloudCentre = {0.1F, 0.0F, 1.0F};

/// What this machine's processor can run.
inline std::vector<InstructionSet> SupportedSets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (IsSupported(set)) sets.push_back(set);
  }
  return sets;
}

/// The length of the difference over that of what is expected.
inline double RelativeDistance(std::span<const float> expected, std::span<const float> actual) {
  double squared = 0;
  double difference = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    squared += static_cast<double>(expected[i]) * expected[i];
    difference += std::pow(static_cast<double>(expected[i]) - actual[i], 2);
  }
  return std::sqrt(difference / std::max(squared, 1e-30));
}

}  // namespace doorforge::testing

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "doorforge/networks/training_sample.h"

namespace doorforge::testing {

/// Samples made from a formula: the hinge angle shows in the cloud and, noisily, in the state; the
/// action is the outward step and the hand's turn that belong to it.
struct SyntheticSamples {
  std::vector<std::vector<float>> clouds;
  std::vector<TrainingSample> samples;  ///< Point into `clouds`.
};
SyntheticSamples MakeSyntheticSamples(std::uint64_t seed, std::size_t count);

}  // namespace doorforge::testing

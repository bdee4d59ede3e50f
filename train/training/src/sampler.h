// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace doorforge::internal {

/// Sample indices of a step: a cut of the epoch's own permutation, a pure function of the
/// arguments. `batch` <= `samples`.
std::vector<std::size_t> BatchOf(std::uint64_t seed, std::uint64_t epoch, std::uint64_t step,
                                 std::size_t samples, std::size_t batch);

/// `count` standard normal numbers for a step (counted over the whole run).
std::vector<float> LatentNoise(std::uint64_t seed, std::uint64_t step, std::size_t count);

}  // namespace doorforge::internal

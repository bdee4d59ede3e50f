// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "sampler.h"

#include <numeric>
#include <string>
#include <utility>

#include "doorforge/core/rng.h"

namespace doorforge::internal {

std::vector<std::size_t> BatchOf(std::uint64_t seed, std::uint64_t epoch, std::uint64_t step,
                                 std::size_t samples, std::size_t batch) {
  std::vector<std::size_t> order(samples);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Rng rng(seed, "train/epoch/" + std::to_string(epoch));
  for (std::size_t i = samples; i > 1; --i)
    std::swap(order[i - 1], order[rng.Index(static_cast<std::uint32_t>(i))]);
  const auto begin = order.begin() + static_cast<std::ptrdiff_t>(step * batch);
  return {begin, begin + static_cast<std::ptrdiff_t>(batch)};
}

std::vector<float> LatentNoise(std::uint64_t seed, std::uint64_t step, std::size_t count) {
  Rng rng(seed, "train/noise/" + std::to_string(step));
  std::vector<float> noise(count);
  for (float& value : noise) value = static_cast<float>(rng.Normal());
  return noise;
}

}  // namespace doorforge::internal

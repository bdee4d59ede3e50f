// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "seen_point.h"

namespace doorforge {

/// How many of the places of each lamp, and of the surroundings, a pixel has in sight: four counts.
class LightShares {
 public:
  static constexpr std::size_t kAround = kMostLamps;  ///< Place of the surroundings, whose places
  static constexpr std::uint32_t kAroundUnit = 64;    ///< count so much each, or less if near.

  LightShares() = default;
  /// The counts of several pixels together.
  explicit LightShares(std::uint64_t packed) : packed_(packed) {}

  std::uint32_t Of(std::size_t light) const {
    return static_cast<std::uint32_t>(packed_ >> (kBits * light) & 0xFFFFU);
  }
  void Add(std::size_t light, std::uint64_t count) { packed_ += count << (kBits * light); }
  std::uint64_t packed() const { return packed_; }

 private:
  static constexpr std::size_t kBits = 16;
  static_assert(kMostLamps == 3, "four counts fit");
  std::uint64_t packed_ = 0;
};

/// What reaches each pixel, 0 to 16 * rounds of each light: lamps and surroundings are sampled as
/// Keller and Heidrich (Interleaved Sampling, 2001) do. Of 16 places of a lamp, the pixels of a
/// block of 4 x 4 look for different ones, and those that see the same surface share what they
/// find. In a group of 8 x 8 pixels that see one surface a quarter looks first; where they agree on
/// a lamp, the others are not asked.
///
/// @param rounds So many times each pixel looks for a place.
std::vector<LightShares> ShareLight(const LitScene& scene, const PointImage& image, int rounds);

}  // namespace doorforge

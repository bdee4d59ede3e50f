// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace doorforge {

/// Counter-based random numbers: Philox4x32-10 (Salmon et al., SC 2011).
///
/// A stream is a pure function of (seed, stream name), so the numbers that an episode draws depend
/// neither on threads nor on what was drawn before it. Name streams by asset, episode and purpose:
/// `Rng(seed, "scene/" + door_id + "/12/base")`. All results are the same on every platform.
class Rng {
 public:
  Rng(std::uint64_t seed, std::string_view stream);

  std::uint32_t NextUint32();
  /// Uniform in [0, 1) with 53 random bits.
  double Uniform();
  /// Uniform in [low, high); low <= high, both finite.
  double Uniform(double low, double high);
  /// Uniform in {0, ..., count - 1} without bias; count > 0.
  std::uint32_t Index(std::uint32_t count);
  /// Standard normal (Box-Muller, two draws a call).
  double Normal();

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
};

/// One Philox4x32-10 block, exposed for checking against the published vectors.
std::array<std::uint32_t, 4> Philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

}  // namespace doorforge

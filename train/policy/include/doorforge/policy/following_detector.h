// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/schemas/policy.h"

namespace doorforge {

/// When what the fingers hold counts as having come with the hand.
struct FollowingConfig {
  /// The hand is so far from where it began [m]. On the validation side no door that stayed shut
  /// let a hand come farther than 0.11 m with its fingers apart, since it slides off the handle
  /// before.
  double way_m = 0.11;
  /// The fingers are apart by at least this share of what they were apart at the beginning: a hand
  /// that has lost the handle closes them.
  double kept_share = 0.8;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("way_m", self.way_m);
    visit("kept_share", self.kept_share);
  }
};

/// Says from hand and fingers alone whether what they hold gives way. Deterministic.
class FollowingDetector {
 public:
  /// @throws Error(kInvalidConfig) unless way_m is above 0 and kept_share 0 to 1.
  explicit FollowingDetector(const FollowingConfig& config);

  void Reset() { start_.reset(); }
  /// Whether it has given way by now; the first call after a Reset() is the beginning.
  bool Follows(const Proprioception& now);

 private:
  FollowingConfig config_;
  std::optional<Proprioception> start_;
};

}  // namespace doorforge

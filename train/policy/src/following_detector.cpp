// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/following_detector.h"

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr double kClosed = -1;  // of a finger, see Proprioception

// Between the fingers, in units of half a finger's way.
double GapOf(const Proprioception& proprioception) {
  return static_cast<double>(FingerOpeningsOf(proprioception).sum()) - 2 * kClosed;
}

}  // namespace

FollowingDetector::FollowingDetector(const FollowingConfig& config) : config_(config) {
  Require(config.way_m > 0, ErrorCode::kInvalidConfig, "policy.following.way_m: must be above 0");
  Require(config.kept_share >= 0 && config.kept_share <= 1, ErrorCode::kInvalidConfig,
          "policy.following.kept_share: must be 0 to 1");
}

bool FollowingDetector::Follows(const Proprioception& now) {
  if (!start_) start_ = now;
  const double way_m = static_cast<double>((HandPositionOf(now) - HandPositionOf(*start_)).norm());
  return way_m >= config_.way_m && GapOf(now) >= config_.kept_share * GapOf(*start_);
}

}  // namespace doorforge

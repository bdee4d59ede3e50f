// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "action_scaling.h"

#include <algorithm>
#include <cmath>

namespace doorforge::internal {
namespace {

constexpr std::size_t kPositionNumbers = 3;

}  // namespace

std::vector<float> ActionScaling::Scaled(std::span<const float> actions) const {
  std::vector<float> scaled;
  scaled.reserve(actions.size());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const std::size_t k = i % kActionNumbers;
    const double value = (static_cast<double>(actions[i]) - offset.at(k)) / scale.at(k);
    // the ends of the range may round to beyond it
    scaled.push_back(static_cast<float>(std::clamp(value, -1.0, 1.0)));
  }
  return scaled;
}

void ActionRange::Add(std::span<const float> actions) {
  for (std::size_t i = 0; i < actions.size(); ++i) {
    Range& range = ranges_.at(i % kActionNumbers);
    range.low = std::min(range.low, static_cast<double>(actions[i]));
    range.high = std::max(range.high, static_cast<double>(actions[i]));
  }
}

ActionScaling ActionRange::Scaling() const {
  ActionScaling scaling{};
  scaling.scale.fill(1);
  for (std::size_t k = 0; k < kActionNumbers; ++k) {
    const Range& range = ranges_.at(k);
    if (range.low > range.high) continue;  // no action at all
    if (k >= kPositionNumbers) {
      scaling.scale.at(k) = std::max({1.0, std::abs(range.low), std::abs(range.high)});
      continue;
    }
    scaling.offset.at(k) = (range.low + range.high) / 2;
    if (range.high > range.low) scaling.scale.at(k) = (range.high - range.low) / 2;
  }
  return scaling;
}

}  // namespace doorforge::internal

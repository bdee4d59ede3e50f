// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/wilson_interval.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr double kNormalQuantile975 = 1.959963984540054;

}  // namespace

Interval WilsonInterval(double successes, double trials) {
  Require(successes >= 0 && successes <= trials, ErrorCode::kInvalidArgument,
          std::to_string(successes) + " successes of " + std::to_string(trials) +
              " trials: expected 0 <= successes <= trials");
  if (trials == 0) return {};
  const double p = successes / trials;
  const double z2 = kNormalQuantile975 * kNormalQuantile975;
  const double center = (p + z2 / (2 * trials)) / (1 + z2 / trials);
  const double half = kNormalQuantile975 / (1 + z2 / trials) *
                      std::sqrt(p * (1 - p) / trials + z2 / (4 * trials * trials));
  // at 0 and n successes one end is exactly 0 or 1; rounding must not say otherwise
  return {successes == 0 ? 0 : std::max(0.0, center - half),
          successes == trials ? 1 : std::min(1.0, center + half)};
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/html_numbers.h"

#include <algorithm>
#include <numbers>

namespace doorforge::internal {

std::string Degrees(double angle_rad) { return Fixed(angle_rad * 180 / std::numbers::pi, 1) + "°"; }

namespace {

// What is not all is not 100 %, and what is not nothing not 0 %.
std::string PercentNumber(double share) {
  const bool near_an_end = (share > 0.99 && share < 1) || (share > 0 && share < 0.01);
  return near_an_end ? Fixed(std::clamp(100 * share, 0.1, 99.9), 1) : Fixed(100 * share, 0);
}

}  // namespace

std::string Percent(double share) { return PercentNumber(share) + "\u00a0%"; }

std::string IntervalText(const SuccessRate& rate) {
  return PercentNumber(rate.low) + "\u2060–\u2060" + Percent(rate.high);
}

}  // namespace doorforge::internal

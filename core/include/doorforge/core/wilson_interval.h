// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// The ends of an interval at 95 % confidence of a share, 0 <= low <= high <= 1.
struct Interval {
  double low = 0;
  double high = 1;
};

/// Returns Wilson's score interval (Wilson 1927) of independent trials; 0 to 1 where there are
/// none. Throws Error(kInvalidArgument) unless 0 <= successes <= trials; they need not be whole
/// numbers.
Interval WilsonInterval(double successes, double trials);

}  // namespace doorforge

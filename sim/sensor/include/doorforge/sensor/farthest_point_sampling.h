// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace doorforge {

/// Which vector instructions the sampling uses. All levels give the same indices.
enum class SimdLevel { kBaseline, kAvx2, kAvx512 };

/// The widest level that this processor has.
SimdLevel BestSimdLevel();

/// Farthest point sampling (Eldar et al., 1997): starting with `start`, takes again and again the
/// point with the largest distance to the points taken so far.
///
/// Exact: the result is that of the plain algorithm, whatever the level, for squared distances
/// computed in float as (dx * dx + dy * dy) + dz * dz without fused operations. Among equally far
/// points the lowest index wins; no index is taken twice, so of points that coincide all are taken
/// once nothing farther is left.
///
/// Points are kept in boxes of some hundreds (Han et al., "QuickFPS", 2023); a box is visited only
/// if the new point can be nearer to one of its points than all earlier ones.
///
/// @param xyz Points, N x 3 row by row, |coordinate| < 1e15.
/// @param count Number of points to take, in [1, N].
/// @param start Index of the first one, in [0, N).
/// @return `count` indices in the order in which they were taken.
/// @throws Error(kInvalidArgument) if an argument is out of range.
std::vector<std::int32_t> FarthestPoints(std::span<const float> xyz, int count, int start,
                                         SimdLevel level = BestSimdLevel());

}  // namespace doorforge

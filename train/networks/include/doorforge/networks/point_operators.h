// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/networks/instruction_set.h"

namespace doorforge {

/// Points as three arrays of equal length [m]: the layout the operators read fastest.
struct PointColumns {
  std::vector<float> x, y, z;

  std::size_t size() const { return x.size(); }
  std::array<float, 3> operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  /// The points with these indices, in their order.
  PointColumns Select(std::span<const std::uint16_t> indices) const;
};

/// `xyz` is N x 3 row by row, N <= 65535; `centre` is subtracted.
PointColumns ToColumns(std::span<const float> xyz, const std::array<float, 3>& centre);

/// Farthest point sampling (PointNet++, Section 3.2): index 0 first, then always the point farthest
/// from all chosen ones, the lowest index on a tie. count <= points. The same on every processor.
std::vector<std::uint16_t> FarthestPoints(const PointColumns& points, int count,
                                          InstructionSet set);

/// Ball query (PointNet++): the lowest indices, at most `limit`, of the points closer to `centre`
/// than `radius_m`. The reference pads the list with its first entry; here it is simply shorter.
std::vector<std::uint16_t> PointsWithin(const PointColumns& points,
                                        const std::array<float, 3>& centre, float radius_m,
                                        int limit, InstructionSet set);

struct NearestThree {
  std::array<std::uint16_t, 3> index;  ///< Nearest first; the lowest index on a tie.
  std::array<float, 3> weight;         ///< 1 / (squared distance + 1e-8), divided by their sum.
};

/// Three nearest points with interpolation weights (PointNet++, eq. 2). At least three points.
NearestThree ThreeNearest(const PointColumns& points, const std::array<float, 3>& query);

}  // namespace doorforge

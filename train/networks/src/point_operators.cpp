// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/point_operators.h"

#include <limits>

#include "doorforge/core/error.h"

#include "kernel_choice.h"

namespace doorforge {
namespace {

internal::PointArrays View(const PointColumns& points) {
  return {points.x.data(), points.y.data(), points.z.data(), static_cast<int>(points.size())};
}

}  // namespace

PointColumns PointColumns::Select(std::span<const std::uint16_t> indices) const {
  PointColumns chosen;
  for (const std::uint16_t i : indices) {
    chosen.x.push_back(x[i]);
    chosen.y.push_back(y[i]);
    chosen.z.push_back(z[i]);
  }
  return chosen;
}

PointColumns ToColumns(std::span<const float> xyz, const std::array<float, 3>& centre) {
  const std::size_t count = xyz.size() / 3;
  Require(count * 3 == xyz.size() && count <= 65535, ErrorCode::kInvalidArgument,
          "a cloud must hold at most 65535 points of three numbers");
  PointColumns points;
  for (std::size_t i = 0; i < count; ++i) {
    points.x.push_back(xyz[3 * i] - centre[0]);
    points.y.push_back(xyz[3 * i + 1] - centre[1]);
    points.z.push_back(xyz[3 * i + 2] - centre[2]);
  }
  return points;
}

std::vector<std::uint16_t> FarthestPoints(const PointColumns& points, int count,
                                          InstructionSet set) {
  Require(count >= 0 && static_cast<std::size_t>(count) <= points.size(),
          ErrorCode::kInvalidArgument, "cannot sample more points than there are");
  const internal::Kernels& kernels = internal::KernelsFor(set);
  std::vector<float> nearest(points.size(), std::numeric_limits<float>::max());
  std::vector<std::uint16_t> chosen(static_cast<std::size_t>(count));
  std::uint16_t current = 0;
  for (std::uint16_t& index : chosen) {
    index = current;
    const std::array<float, 3> from = points[current];
    current = static_cast<std::uint16_t>(
        kernels.update_nearest(View(points), from.data(), nearest.data()));
  }
  return chosen;
}

std::vector<std::uint16_t> PointsWithin(const PointColumns& points,
                                        const std::array<float, 3>& centre, float radius_m,
                                        int limit, InstructionSet set) {
  std::vector<std::uint16_t> found(static_cast<std::size_t>(limit));
  const int count = internal::KernelsFor(set).find_within(View(points), centre.data(),
                                                          radius_m * radius_m, limit, found.data());
  found.resize(static_cast<std::size_t>(count));
  return found;
}

NearestThree ThreeNearest(const PointColumns& points, const std::array<float, 3>& query) {
  Require(points.size() >= 3, ErrorCode::kInvalidArgument, "interpolation needs three points");
  std::array<float, 3> distance;
  distance.fill(std::numeric_limits<float>::max());
  NearestThree nearest{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float dx = points.x[i] - query[0];
    const float dy = points.y[i] - query[1];
    const float dz = points.z[i] - query[2];
    const float d = dx * dx + dy * dy + dz * dz;
    std::size_t place = 3;
    while (place > 0 && d < distance[place - 1]) --place;
    if (place == 3) continue;
    for (std::size_t j = 2; j > place; --j) {
      distance[j] = distance[j - 1];
      nearest.index[j] = nearest.index[j - 1];
    }
    distance[place] = d;
    nearest.index[place] = static_cast<std::uint16_t>(i);
  }
  float sum = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    nearest.weight[j] = 1.0F / (distance[j] + 1e-8F);
    sum += nearest.weight[j];
  }
  for (float& weight : nearest.weight) weight /= sum;
  return nearest;
}

}  // namespace doorforge

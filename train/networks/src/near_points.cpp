// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/near_points.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "doorforge/networks/stage_networks.h"

namespace doorforge::internal {
namespace {

constexpr float kUnit = 0.05F;         // [m]
constexpr std::ptrdiff_t kPatch = 12;  // rows of the largest register tile; others divide it

// Halves the points along their widest side until a patch is left, into whole patches each time.
void Halve(const Eigen::Matrix3Xf& points, std::span<Eigen::Index> order) {
  const auto patches = (std::ssize(order) + kPatch - 1) / kPatch;
  if (patches < 2) return;
  const auto chosen = points(Eigen::all, order);
  Eigen::Index side = 0;
  (chosen.rowwise().maxCoeff() - chosen.rowwise().minCoeff()).maxCoeff(&side);
  const std::span<Eigen::Index> first = order.first(static_cast<std::size_t>(patches / 2 * kPatch));
  // of equal points the one that came first stays first, whatever the library's sort
  std::nth_element(order.begin(), first.end(), order.end(), [&](auto one, auto other) {
    return std::pair(points(side, one), one) < std::pair(points(side, other), other);
  });
  Halve(points, first);
  Halve(points, order.subspan(first.size()));
}

}  // namespace

Eigen::Matrix3Xf NearestToFirst(std::span<const float> xyz, int count) {
  const Eigen::Map<const Eigen::Matrix3Xf> points(xyz.data(), 3,
                                                  static_cast<Eigen::Index>(xyz.size() / 3));
  std::vector<std::pair<float, Eigen::Index>> order;  // squared distance; the first of equals first
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const float squared = (points.col(i) - points.col(0)).squaredNorm();
    if (squared <= kNearRadius * kNearRadius) order.emplace_back(squared, i);
  }
  const auto kept = std::min(order.size(), static_cast<std::size_t>(count));
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end());
  Eigen::Matrix3Xf near = Eigen::Matrix3Xf::Zero(3, count);
  for (std::size_t i = 0; i < kept; ++i)
    near.col(static_cast<Eigen::Index>(i)) = points.col(order[i].second) - points.col(0);
  return near;
}

Eigen::Matrix3Xf InPatches(const Eigen::Matrix3Xf& near) {
  // point 0 is the first; what equals it stands in for others
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < near.cols(); ++i) {
    if (i == 0 || near.col(i) != near.col(0)) order.push_back(i);
  }
  Halve(near, order);
  return near(Eigen::all, order);
}

void AppendInHandFrame(const Eigen::Matrix3Xf& near, const Eigen::Matrix3d& world_from_hand,
                       std::vector<float>& out) {
  const std::size_t before = out.size();
  out.resize(before + static_cast<std::size_t>(near.size()));
  Eigen::Map<Eigen::Matrix3Xf>(out.data() + before, 3, near.cols()).noalias() =
      world_from_hand.cast<float>().transpose().lazyProduct(near) / kUnit;
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/handle_points.h"

#include <algorithm>
#include <array>
#include <limits>

#include "doorforge/schemas/cloud.h"

namespace doorforge::internal {

std::vector<std::size_t> HandlePointsOf(std::span<const std::uint8_t> label) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label[i] == static_cast<std::uint8_t>(PointLabel::kHandle)) points.push_back(i);
  }
  return points;
}

std::size_t MiddlePoint(std::span<const float> xyz, std::span<const std::size_t> points) {
  std::array<double, 3> mean{};
  for (const std::size_t point : points) {
    for (std::size_t k = 0; k < 3; ++k) mean[k] += xyz[3 * point + k];
  }
  for (double& coordinate : mean) coordinate /= static_cast<double>(points.size());
  std::size_t nearest = points.front();
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t point : points) {
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double difference = xyz[3 * point + k] - mean[k];
      squared += difference * difference;
    }
    if (squared >= least) continue;
    least = squared;
    nearest = point;
  }
  return nearest;
}

namespace {

template <class T>
std::vector<T> WithFirst(std::span<const T> points, std::size_t first) {
  std::vector<T> swapped(points.begin(), points.end());
  if (swapped.empty()) return swapped;
  for (std::size_t k = 0; k < 3; ++k) std::swap(swapped[k], swapped[3 * first + k]);
  return swapped;
}

}  // namespace

std::vector<float> BeginningAt(std::span<const float> xyz, std::size_t first) {
  return WithFirst(xyz, first);
}

std::vector<std::uint8_t> BeginningAt(std::span<const std::uint8_t> rgb, std::size_t first) {
  return WithFirst(rgb, first);
}

std::array<float, 3> GraspOrigin(const StageNormalisation& normalisation,
                                 std::span<const float> xyz) {
  if (normalisation.view.frame == ViewFrame::kWorld) return {};
  return {xyz[0], xyz[1], xyz[2]};
}

CloudWindow GraspWindow(const StageNormalisation& normalisation, std::span<const float> xyz) {
  return WindowOf(normalisation, {xyz[0], xyz[1], xyz[2]});
}

CloudWindow PlaceWindow(std::span<const float> xyz) {
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < xyz.size(); ++i) mean.at(i % 3) += static_cast<double>(xyz[i]);
  CloudWindow window;
  for (std::size_t k = 0; k < 3; ++k)
    window.centre.at(k) = static_cast<float>(mean.at(k) / (static_cast<double>(xyz.size()) / 3));
  return window;
}

std::vector<std::size_t> PointsInWindow(std::span<const float> xyz, const CloudWindow& window,
                                        std::span<const std::size_t> points) {
  std::vector<std::size_t> inside;
  for (const std::size_t point : points) {
    float squared = 0;
    for (std::size_t k = 0; k < 3; ++k)
      squared += (xyz[3 * point + k] - xyz[k]) * (xyz[3 * point + k] - xyz[k]);
    // a little less than the radius: the geometry's own distances are rounded otherwise
    if (window.crop_radius_m <= 0 || squared < 0.999F * window.crop_radius_m * window.crop_radius_m)
      inside.push_back(point);
  }
  return inside;
}

}  // namespace doorforge::internal

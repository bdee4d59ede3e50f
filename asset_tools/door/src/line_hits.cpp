// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "line_hits.h"

#include <algorithm>
#include <array>

namespace doorforge::internal {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// the coordinate along the line where it meets the triangle; edges belong to the triangle
std::optional<double> MeetsTriangle(const std::array<Eigen::Vector3d, 3>& corners, int axis,
                                    const Eigen::Vector2d& at) {
  std::array<Eigen::Vector2d, 3> flat;
  for (std::size_t i = 0; i < 3; ++i)
    flat[i] = {corners[i][(axis + 1) % 3] - at.x(), corners[i][(axis + 2) % 3] - at.y()};
  const double a = Cross(flat[1], flat[2]);
  const double b = Cross(flat[2], flat[0]);
  const double c = Cross(flat[0], flat[1]);
  const double sum = a + b + c;
  if (sum == 0 || std::min({a, b, c}) * std::max({a, b, c}) < 0) return std::nullopt;
  return (a * corners[0][axis] + b * corners[1][axis] + c * corners[2][axis]) / sum;
}

}  // namespace

std::optional<LineHits> HitsAlong(const TriangleMesh& mesh, int axis, const Eigen::Vector2d& at) {
  std::optional<LineHits> hits;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> corners = {
        mesh.vertices[static_cast<std::size_t>(triangle[0])],
        mesh.vertices[static_cast<std::size_t>(triangle[1])],
        mesh.vertices[static_cast<std::size_t>(triangle[2])]};
    const std::optional<double> hit = MeetsTriangle(corners, axis, at);
    if (!hit) continue;
    if (!hits) hits = LineHits{*hit, *hit};
    hits->first = std::min(hits->first, *hit);
    hits->last = std::max(hits->last, *hit);
  }
  return hits;
}

}  // namespace doorforge::internal

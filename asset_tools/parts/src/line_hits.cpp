// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/line_hits.h"

#include <algorithm>
#include <array>
#include <string>

#include "doorforge/core/error.h"

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

std::array<Eigen::Vector3d, 3> CornersOf(const TriangleMesh& mesh,
                                         const Eigen::Vector3i& triangle) {
  return {mesh.vertices[static_cast<std::size_t>(triangle[0])],
          mesh.vertices[static_cast<std::size_t>(triangle[1])],
          mesh.vertices[static_cast<std::size_t>(triangle[2])]};
}

void AddHit(const std::optional<double>& hit, std::optional<LineHits>& hits) {
  if (!hit) return;
  if (!hits) hits = LineHits{*hit, *hit};
  hits->first = std::min(hits->first, *hit);
  hits->last = std::max(hits->last, *hit);
}

}  // namespace

std::optional<LineHits> HitsAlong(const TriangleMesh& mesh, int axis, const Eigen::Vector2d& at) {
  std::optional<LineHits> hits;
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    AddHit(MeetsTriangle(CornersOf(mesh, triangle), axis, at), hits);
  return hits;
}

namespace {

constexpr std::size_t kMaxEntries = 50'000'000;  // bounds the memory

std::size_t CellIndex(int row, int column, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

}  // namespace

LinesAlongX::LinesAlongX(const TriangleMesh& mesh)
    : cells_(static_cast<std::size_t>(kCells) * kCells) {
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    triangles_.push_back(CornersOf(mesh, triangle));
    for (const Eigen::Vector3d& corner : triangles_.back()) bounds_.extend(corner.tail<2>().eval());
  }
  std::size_t entries = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& corner : triangles_[i]) box.extend(corner.tail<2>().eval());
    for (int row = CellOf(box.min().x(), 0); row <= CellOf(box.max().x(), 0); ++row) {
      for (int column = CellOf(box.min().y(), 1); column <= CellOf(box.max().y(), 1); ++column) {
        cells_[CellIndex(row, column, kCells)].push_back(static_cast<int>(i));
        ++entries;
      }
    }
    if (entries > kMaxEntries)
      throw Error(ErrorCode::kFormat, "the triangles of a leaf cover " + std::to_string(entries) +
                                          " cells of its outline, allowed " +
                                          std::to_string(kMaxEntries) + "; simplify its mesh");
  }
}

int LinesAlongX::CellOf(double coordinate, int axis) const {
  const double size = std::max(bounds_.sizes()[axis], 1e-9);
  const double at = (coordinate - bounds_.min()[axis]) / size * kCells;
  return std::clamp(static_cast<int>(at), 0, kCells - 1);
}

std::optional<LineHits> LinesAlongX::At(const Eigen::Vector2d& at) const {
  if (triangles_.empty() || !bounds_.contains(at)) return std::nullopt;
  std::optional<LineHits> hits;
  for (const int i : cells_[CellIndex(CellOf(at.x(), 0), CellOf(at.y(), 1), kCells)])
    AddHit(MeetsTriangle(triangles_[static_cast<std::size_t>(i)], 0, at), hits);
  return hits;
}

}  // namespace doorforge::internal

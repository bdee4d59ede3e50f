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
    : first_of_(static_cast<std::size_t>(kCells) * kCells + 1, 0) {
  triangles_.reserve(mesh.triangles.size());
  boxes_.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    triangles_.push_back(CornersOf(mesh, triangle));
    boxes_.emplace_back();
    for (const Eigen::Vector3d& corner : triangles_.back())
      boxes_.back().extend(corner.tail<2>().eval());
    bounds_.extend(boxes_.back());
  }
  for (int axis = 0; axis < 2; ++axis)
    cells_per_m_[axis] = kCells / std::max(bounds_.sizes()[axis], 1e-9);
  std::size_t entries = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Cover cover = CoverOf(i);
    for (int row = cover.first_row; row <= cover.last_row; ++row) {
      for (int column = cover.first_column; column <= cover.last_column; ++column)
        ++first_of_[CellIndex(row, column, kCells) + 1];
      entries += static_cast<std::size_t>(cover.last_column - cover.first_column + 1);
    }
    if (entries > kMaxEntries)
      throw Error(ErrorCode::kFormat, "the triangles of a leaf cover " + std::to_string(entries) +
                                          " cells of its outline, allowed " +
                                          std::to_string(kMaxEntries) + "; simplify its mesh");
  }
  for (std::size_t cell = 1; cell < first_of_.size(); ++cell)
    first_of_[cell] += first_of_[cell - 1];
  over_.resize(entries);
  std::vector<std::uint32_t> next(first_of_.begin(), first_of_.end() - 1);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Cover cover = CoverOf(i);
    for (int row = cover.first_row; row <= cover.last_row; ++row) {
      for (int column = cover.first_column; column <= cover.last_column; ++column)
        over_[next[CellIndex(row, column, kCells)]++] = static_cast<int>(i);
    }
  }
}

int LinesAlongX::CellOf(double coordinate, int axis) const {
  const double at = (coordinate - bounds_.min()[axis]) * cells_per_m_[axis];
  return std::clamp(static_cast<int>(at), 0, kCells - 1);
}

LinesAlongX::Cover LinesAlongX::CoverOf(std::size_t triangle) const {
  const Eigen::AlignedBox2d& box = boxes_[triangle];
  return {CellOf(box.min().x(), 0), CellOf(box.max().x(), 0), CellOf(box.min().y(), 1),
          CellOf(box.max().y(), 1)};
}

std::optional<LineHits> LinesAlongX::At(const Eigen::Vector2d& at) const {
  if (triangles_.empty() || !bounds_.contains(at)) return std::nullopt;
  std::optional<LineHits> hits;
  const std::size_t cell = CellIndex(CellOf(at.x(), 0), CellOf(at.y(), 1), kCells);
  for (std::uint32_t k = first_of_[cell]; k < first_of_[cell + 1]; ++k) {
    const auto i = static_cast<std::size_t>(over_[k]);
    if (boxes_[i].contains(at)) AddHit(MeetsTriangle(triangles_[i], 0, at), hits);
  }
  return hits;
}

}  // namespace doorforge::internal

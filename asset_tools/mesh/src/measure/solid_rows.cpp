// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/solid_rows.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// On which side of the edge a -> b the point lies. Evaluated from the vertex with the smaller index
// and with a fixed answer on the line, so that two triangles at one edge never both claim, or both
// disclaim, a point on it.
bool IsLeftOf(const TriangleMesh& mesh, int a, int b, const Vector2d& point) {
  const bool swapped = a > b;
  if (swapped) std::swap(a, b);
  const Vector2d p = mesh.vertices[static_cast<std::size_t>(a)].tail<2>();
  const Vector2d q = mesh.vertices[static_cast<std::size_t>(b)].tail<2>();
  const double side = (q.x() - p.x()) * (point.y() - p.y()) - (q.y() - p.y()) * (point.x() - p.x());
  return (side >= 0) != swapped;
}

constexpr std::size_t kMaxCrossings = 20'000'000;  // bounds the memory

struct RowRange {
  int low_j, high_j, low_k, high_k;  // inclusive
};

RowRange RowsOf(const Eigen::AlignedBox3d& box, const Grid& grid) {
  const auto cell = [&](double position, int axis) {
    return (position - grid.origin_m[axis]) / grid.cell_m - 0.5;
  };
  const auto clamped = [&](double row, int axis) {
    return static_cast<int>(std::clamp(row, 0.0, static_cast<double>(grid.size[axis] - 1)));
  };
  return {clamped(std::floor(cell(box.min().y(), 1)), 1),
          clamped(std::ceil(cell(box.max().y(), 1)), 1),
          clamped(std::floor(cell(box.min().z(), 2)), 2),
          clamped(std::ceil(cell(box.max().z(), 2)), 2)};
}

double PlaneX(const Vector3d& a, const Vector3d& normal, const Vector2d& point) {
  return a.x() - (normal.y() * (point.x() - a.y()) + normal.z() * (point.y() - a.z())) / normal.x();
}

// Returns how many crossings it added.
std::size_t AddTriangle(const TriangleMesh& mesh, const Eigen::Vector3i& t, const Grid& grid,
                        std::vector<std::vector<Crossing>>& rows) {
  std::size_t added = 0;
  const Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  const Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[1])];
  const Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[2])];
  Eigen::AlignedBox3d box(a);
  box.extend(b).extend(c);
  const Vector3d normal = (b - a).cross(c - a);
  const RowRange range = RowsOf(box, grid);
  for (int k = range.low_k; k <= range.high_k; ++k) {
    CheckWork(static_cast<unsigned>(range.high_j - range.low_j + 1));
    for (int j = range.low_j; j <= range.high_j; ++j) {
      const Vector2d point = grid.CenterOf(0, j, k).tail<2>();
      const bool left = IsLeftOf(mesh, t[0], t[1], point);
      if (left != IsLeftOf(mesh, t[1], t[2], point) || left != IsLeftOf(mesh, t[2], t[0], point))
        continue;
      const double x = normal.x() != 0 ? PlaneX(a, normal, point) : a.x();
      // counter-clockwise seen along -x means facing +x: the line comes out there
      rows[static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.size.y()) +
           static_cast<std::size_t>(j)]
          .push_back({std::clamp(x, box.min().x(), box.max().x()), left ? -1 : 1});
      ++added;
    }
  }
  return added;
}

}  // namespace

std::vector<std::vector<Crossing>> RowCrossings(const TriangleMesh& mesh, const Grid& grid) {
  std::vector<std::vector<Crossing>> rows(static_cast<std::size_t>(grid.size.y()) *
                                          static_cast<std::size_t>(grid.size.z()));
  std::size_t crossings = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    crossings += AddTriangle(mesh, t, grid, rows);
    if (crossings > kMaxCrossings)
      throw Error(ErrorCode::kFormat, "a mesh crosses the rows of its grid more than " +
                                          std::to_string(kMaxCrossings) +
                                          " times, which is as often as is allowed; simplify it");
  }
  for (std::vector<Crossing>& row : rows) {
    std::stable_sort(row.begin(), row.end(), [](const Crossing& s, const Crossing& t) {
      return std::pair(s.x_m, -s.winding) < std::pair(t.x_m, -t.winding);
    });
  }
  return rows;
}

Grid GridOver(const TriangleMesh& mesh, double cell_m, int margin) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  Grid grid;
  grid.cell_m = cell_m;
  const Vector3d cells = box.sizes() / cell_m;
  for (int axis = 0; axis < 3; ++axis)
    grid.size[axis] = static_cast<int>(std::ceil(cells[axis])) + 2 * margin;
  grid.origin_m = box.center() - 0.5 * cell_m * grid.size.cast<double>();
  return grid;
}

double CellFor(const TriangleMesh& mesh, double cell_m, int margin, int max_cells) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const auto cells = [&](double size) {
    double product = 1;
    for (const double length : box.sizes())
      product *= std::max(1.0, std::ceil(length / size)) + 2 * margin;
    return product;
  };
  while (cells(cell_m) > max_cells) cell_m *= 1.05;
  return cell_m;
}

}  // namespace doorforge

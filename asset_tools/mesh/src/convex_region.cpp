// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex_region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

// How far a point lies outside of the half-spaces' intersection; negative inside.
double Outside(const std::vector<HalfSpace>& faces, const Eigen::Vector3d& point) {
  double outside = -1e300;
  for (const HalfSpace& face : faces)
    outside = std::max(outside, face.normal.dot(point) - face.offset);
  return outside;
}

// Extreme vertices along the axes and the diagonals of a cube: a tetrahedron at least.
std::vector<Eigen::Vector3d> Extremes(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<Eigen::Vector3d> chosen;
  for (int code = 0; code < 27; ++code) {
    const Eigen::Vector3d direction =
        Eigen::Vector3i(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).cast<double>();
    if (direction.isZero()) continue;
    const auto farthest = std::max_element(vertices.begin(), vertices.end(),
                                           [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                                             return a.dot(direction) < b.dot(direction);
                                           });
    if (std::find(chosen.begin(), chosen.end(), *farthest) == chosen.end())
      chosen.push_back(*farthest);
  }
  return chosen;
}

struct Range {
  double low;
  double high;
};

// The part of the line (x, y, z) over all x that lies in every half-space.
Range InsideAlongX(const std::vector<HalfSpace>& faces, double y, double z) {
  Range range{-1e300, 1e300};
  for (const HalfSpace& face : faces) {
    const double rest = face.offset - face.normal.y() * y - face.normal.z() * z;
    if (face.normal.x() > 0) range.high = std::min(range.high, rest / face.normal.x());
    if (face.normal.x() < 0) range.low = std::max(range.low, rest / face.normal.x());
    if (face.normal.x() == 0 && rest < 0) return {1, 0};
  }
  return range;
}

// Cells whose centres lie in [low, high] along an axis, kept within the grid.
std::pair<int, int> CellsWithin(const Grid& grid, int axis, double low, double high) {
  const double first = std::ceil((low - grid.origin_m[axis]) / grid.cell_m - 0.5);
  const double last = std::floor((high - grid.origin_m[axis]) / grid.cell_m - 0.5);
  const double end = grid.size[axis] - 1;
  return {static_cast<int>(std::clamp(first, 0.0, end + 1)),
          static_cast<int>(std::clamp(last, -1.0, end))};
}

}  // namespace

std::vector<HalfSpace> HalfSpacesOf(const TriangleMesh& hull) {
  std::vector<HalfSpace> faces;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    // the height over the longest side says whether the normal means anything
    const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
    if (!(length > 1e-9 * longest * longest)) continue;
    const Eigen::Vector3d unit = normal / length;
    faces.push_back({unit, std::max({unit.dot(a), unit.dot(b), unit.dot(c)})});
  }
  return faces;
}

std::optional<TriangleMesh> HullOf(std::span<const Eigen::Vector3d> points) {
  try {
    return ConvexHull(points);
  } catch (const Error&) {
    return std::nullopt;
  }
}

TriangleMesh ReducedHull(const TriangleMesh& hull, int max_vertices) {
  const auto limit = static_cast<std::size_t>(max_vertices);
  if (hull.vertices.size() <= limit) return hull;
  std::vector<Eigen::Vector3d> chosen = Extremes(hull.vertices);
  if (chosen.size() > limit) chosen.resize(limit);
  std::optional<TriangleMesh> reduced = HullOf(chosen);
  while (chosen.size() < limit) {
    const std::vector<HalfSpace> faces =
        reduced ? HalfSpacesOf(*reduced) : std::vector<HalfSpace>{};
    double farthest = 0;
    const Eigen::Vector3d* next = nullptr;
    for (const Eigen::Vector3d& vertex : hull.vertices) {
      if (!reduced && std::find(chosen.begin(), chosen.end(), vertex) == chosen.end())
        next = &vertex;
      const double outside = reduced ? Outside(faces, vertex) : 0;
      if (outside <= farthest) continue;
      farthest = outside;
      next = &vertex;
    }
    if (next == nullptr) break;
    chosen.push_back(*next);
    reduced = HullOf(chosen);
  }
  return reduced ? *reduced : hull;
}

double VolumeOf(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Eigen::Vector3d origin = mesh.vertices[0];
  double volume = 0;
  for (const Eigen::Vector3i& t : mesh.triangles)
    volume += (mesh.vertices[static_cast<std::size_t>(t[0])] - origin)
                  .dot((mesh.vertices[static_cast<std::size_t>(t[1])] - origin)
                           .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - origin)) /
              6;
  return volume;
}

std::vector<Eigen::Vector3d> PointsOn(const TriangleMesh& mesh, double step_m) {
  constexpr std::size_t kMaxPoints = 20'000'000;  // bounds the memory
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d ab = mesh.vertices[static_cast<std::size_t>(t[1])] - a;
    const Eigen::Vector3d ac = mesh.vertices[static_cast<std::size_t>(t[2])] - a;
    const std::int64_t across = 1 + static_cast<std::int64_t>(ab.norm() / step_m);
    const std::int64_t along = 1 + static_cast<std::int64_t>(ac.norm() / step_m);
    for (std::int64_t u = 0; u <= across; ++u) {
      const double u_share = static_cast<double>(u);
      for (std::int64_t v = 0; v * across <= along * (across - u); ++v)
        points.emplace_back(a + ab * u_share / static_cast<double>(across) +
                            ac * static_cast<double>(v) / static_cast<double>(along));
      if (points.size() > kMaxPoints)
        throw Error(ErrorCode::kFormat, "a surface takes more than the " +
                                            std::to_string(kMaxPoints) +
                                            " points allowed; is one of its sides far too long?");
    }
    CheckWork(static_cast<unsigned>(across));
  }
  return points;
}

namespace {

// Visits every `stride`-th row of cells inside the hull, but for those that hold nothing deeper
// than `known_m`; stops where the depth exceeds `stop_m`. The first of the deepest.
Concavity DeepestInside(const TriangleMesh& hull, const DistanceGrid& solid, int stride,
                        double stop_m, double known_m = 0) {
  const Grid& grid = solid.grid();
  const std::vector<HalfSpace> faces = HalfSpacesOf(hull);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : hull.vertices) box.extend(vertex);
  const auto [low_j, high_j] = CellsWithin(grid, 1, box.min().y(), box.max().y());
  const auto [low_k, high_k] = CellsWithin(grid, 2, box.min().z(), box.max().z());
  Concavity deepest{known_m, Eigen::Vector3d::Zero()};
  for (int k = low_k; k <= high_k; k += stride) {
    for (int j = low_j; j <= high_j; j += stride) {
      if (solid.LargestInRow(j, k) <= deepest.depth_m) continue;
      const Eigen::Vector3d center = grid.CenterOf(0, j, k);
      const Range range = InsideAlongX(faces, center.y(), center.z());
      CheckWork(static_cast<unsigned>(faces.size()));
      if (range.low > range.high) continue;
      const auto [low_i, high_i] = CellsWithin(grid, 0, range.low, range.high);
      for (int i = low_i; i <= high_i; ++i) {
        const double depth = solid.DistanceAt(i, j, k);
        if (depth > deepest.depth_m) deepest = {depth, grid.CenterOf(i, j, k)};
      }
      if (deepest.depth_m > stop_m) return deepest;
    }
  }
  return deepest;
}

// The same along the hull's own triangles: a hull thinner than a cell may miss every centre.
Concavity DeepestOnSurface(const TriangleMesh& hull, const DistanceGrid& solid, double step_m) {
  Concavity deepest;
  for (const Eigen::Vector3d& point : PointsOn(hull, step_m)) {
    const Eigen::Vector3i cell = solid.grid().CellAt(point);
    const double depth = solid.DistanceAt(cell.x(), cell.y(), cell.z());
    if (depth > deepest.depth_m) deepest = {depth, point};
  }
  return deepest;
}

bool IsThin(const TriangleMesh& hull, double cell_m) {
  double area = 0;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    area += 0.5 * (hull.vertices[static_cast<std::size_t>(t[1])] - a)
                      .cross(hull.vertices[static_cast<std::size_t>(t[2])] - a)
                      .norm();
  }
  return 2 * VolumeOf(hull) < 2 * cell_m * area;
}

Concavity Deepest(const TriangleMesh& hull, const DistanceGrid& solid, int stride, double stop_m) {
  // what a few rows hold lets most others be left out
  constexpr int kFew = 8;
  const double known_m = DeepestInside(hull, solid, kFew * stride, stop_m).depth_m;
  if (known_m > stop_m) return {known_m, Eigen::Vector3d::Zero()};
  Concavity inside = DeepestInside(hull, solid, stride, stop_m, std::nextafter(known_m, 0));
  const double cell_m = solid.grid().cell_m;
  if (inside.depth_m > stop_m || !IsThin(hull, cell_m)) return inside;
  Concavity surface = DeepestOnSurface(hull, solid, stride * cell_m);
  return surface.depth_m > inside.depth_m ? surface : inside;
}

}  // namespace

Concavity ConcavityOf(const TriangleMesh& hull, const DistanceGrid& solid, int stride) {
  return Deepest(hull, solid, stride, 1e300);
}

double DepthWithin(const TriangleMesh& hull, const DistanceGrid& solid, double allowed_m) {
  // most hulls that protrude do so in many rows, so a few rows settle it
  const double coarse_m = Deepest(hull, solid, 8, allowed_m).depth_m;
  return coarse_m > allowed_m ? coarse_m : Deepest(hull, solid, 1, allowed_m).depth_m;
}

bool StaysWithin(const TriangleMesh& hull, const DistanceGrid& solid, double allowed_m) {
  return DepthWithin(hull, solid, allowed_m) <= allowed_m;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/cover_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "convex/convex_region.h"
#include "convex/hull_depth.h"
#include "measure/surface_samples.h"

namespace doorforge {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kThinnest = 2e-4;      // [m]
constexpr double kCoverSamples = 8000;  // and more where they would lie far apart
constexpr double kMostCoverSamples = 100'000;

// Direction in which the points spread least.
Eigen::Vector3d FlatDirection(const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
}

// Hull of the points, at least `kThinnest` thick.
std::optional<TriangleMesh> ThickHullOf(const Points& points) {
  const auto is_thick = [](const TriangleMesh& hull) {
    // a thin plate has twice its area as surface
    return VolumeOf(hull) >= kThinnest * MeasureTopology(hull).area_m2 / 2;
  };
  std::optional<TriangleMesh> hull = HullOf(points);
  if (hull && is_thick(*hull)) return hull;
  Points wide;
  const Eigen::Vector3d across = FlatDirection(points);
  for (const Eigen::Vector3d& p : hull ? hull->vertices : points) {
    wide.push_back(p + kThinnest * across);
    wide.push_back(p - kThinnest * across);
  }
  hull = HullOf(wide);
  if (hull && is_thick(*hull)) return hull;
  // a needle or a point
  const Points line = std::move(wide);
  wide.clear();
  for (const Eigen::Vector3d& p : line) {
    for (int axis = 0; axis < 3; ++axis) {
      wide.push_back(p + kThinnest * Eigen::Vector3d::Unit(axis));
      wide.push_back(p - kThinnest * Eigen::Vector3d::Unit(axis));
    }
  }
  return HullOf(wide);
}

struct Shape {
  TriangleMesh hull;
  std::vector<HalfSpace> faces;
  Eigen::AlignedBox3d box;
};

Shape ShapeOf(TriangleMesh hull) {
  Shape shape{std::move(hull), {}, {}};
  shape.faces = HalfSpacesOf(shape.hull);
  for (const Eigen::Vector3d& vertex : shape.hull.vertices) shape.box.extend(vertex);
  return shape;
}

bool IsWithin(const Shape& shape, const Eigen::Vector3d& point, double tolerance_m) {
  return shape.box.exteriorDistance(point) <= tolerance_m &&
         std::all_of(shape.faces.begin(), shape.faces.end(), [&](const HalfSpace& face) {
           return face.normal.dot(point) <= face.offset + tolerance_m;
         });
}

Points LeftOut(const Points& probes, const std::vector<Shape>& shapes, double tolerance_m) {
  Points left;
  std::copy_if(probes.begin(), probes.end(), std::back_inserter(left),
               [&](const Eigen::Vector3d& point) {
                 return std::none_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
                   return IsWithin(shape, point, tolerance_m);
                 });
               });
  return left;
}

// Points that hang together through neighbouring cells of a grid.
std::vector<Points> ClustersOf(const Points& points, double cell_m) {
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, Points> cells;
  for (const Eigen::Vector3d& p : points) {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor(p[axis] / cell_m));
    cells[cell].push_back(p);
  }
  std::vector<Points> clusters;
  while (!cells.empty()) {
    std::vector<Cell> pending = {cells.begin()->first};
    Points& cluster = clusters.emplace_back();
    while (!pending.empty()) {
      const Cell at = pending.back();
      pending.pop_back();
      const auto entry = cells.find(at);
      if (entry == cells.end()) continue;
      cluster.insert(cluster.end(), entry->second.begin(), entry->second.end());
      cells.erase(entry);
      for (int n = 0; n < 27; ++n)
        pending.push_back({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
    }
  }
  return clusters;
}

// The points below and above the middle of their longest extent.
std::pair<Points, Points> Halves(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::pair<Points, Points> halves;
  for (const Eigen::Vector3d& p : points)
    (p[axis] < box.center()[axis] ? halves.first : halves.second).push_back(p);
  return halves;
}

// Samples by area pass over strips, whose corners may be covered while their middle is not: so the
// edges and the centres of all triangles are looked at as well.
Points ProbesOf(const TriangleMesh& mesh, int samples, double spacing_m) {
  Points probes = SurfaceSamples(mesh, samples);
  probes.insert(probes.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[corner])];
      center += a / 3;
      if (t[corner] > t[(corner + 1) % 3]) continue;  // the other triangle's turn
      const Eigen::Vector3d way = mesh.vertices[static_cast<std::size_t>(t[(corner + 1) % 3])] - a;
      const int steps = 1 + static_cast<int>(way.norm() / spacing_m);
      for (int i = 1; i < steps; ++i) probes.emplace_back(a + way * i / steps);
    }
    probes.push_back(center);
  }
  return probes;
}

class Cover {
 public:
  Cover(std::vector<TriangleMesh> parts, const DistanceGrid& solid, const CoverLimits& limits)
      : solid_(&solid), limits_(limits) {
    for (TriangleMesh& part : parts) {
      if (std::optional<TriangleMesh> thick = ThickHullOf(part.vertices))
        shapes_.push_back(ShapeOf(ReducedHull(*thick, limits_.max_vertices)));
    }
  }

  std::vector<TriangleMesh> Over(const ClosedMesh& mesh) {
    const double area_m2 = MeasureTopology(mesh.mesh()).area_m2;
    // a gap between parts that is wider than they may reach into air is seen
    const double spacing_m = std::min(std::sqrt(area_m2 / kCoverSamples), limits_.allowed_m);
    const double samples = std::min(area_m2 / (spacing_m * spacing_m), kMostCoverSamples);
    const Points probes = ProbesOf(mesh.mesh(), static_cast<int>(samples), spacing_m);
    constexpr int kCoverRounds =
        5;  // reduced to few vertices, a part may not cover all that it was for
    for (int round = 0; round < kCoverRounds; ++round) {
      const Points left = LeftOut(probes, shapes_, limits_.tolerance_m);
      if (left.empty()) break;
      for (const Points& cluster : ClustersOf(left, std::max(limits_.allowed_m, 2 * spacing_m)))
        Add(cluster);
    }
    std::vector<TriangleMesh> parts;
    for (Shape& shape : shapes_) parts.push_back(std::move(shape.hull));
    return parts;
  }

 private:
  bool StaysWithin(const TriangleMesh& hull) const {
    const DepthRange range{.above_m = limits_.allowed_m, .stop_m = limits_.allowed_m};
    return ConcavityOf(hull, *solid_, range).depth_m == 0;
  }

  void Add(const Points& points) {
    const std::optional<TriangleMesh> hull = ThickHullOf(points);
    if (!hull) return;
    const bool fits = StaysWithin(*hull);
    if (!fits && points.size() > 8) {
      const auto [low, high] = Halves(points);
      Add(low);
      Add(high);
    } else if (static_cast<int>(shapes_.size()) < limits_.max_parts) {
      shapes_.push_back(ShapeOf(ReducedHull(*hull, limits_.max_vertices)));
    } else {
      GrowNearest(*hull);
    }
  }

  // The part near by that reaches least into air afterwards takes the points in.
  void GrowNearest(const TriangleMesh& added) {
    std::optional<TriangleMesh> best;
    Shape* grown = nullptr;
    double least_m = 1e300;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : added.vertices) box.extend(vertex);
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      by_distance.emplace_back(shapes_[i].box.exteriorDistance(box), i);
    std::sort(by_distance.begin(), by_distance.end());
    constexpr std::size_t kNear = 6;
    for (std::size_t i = 0; i < std::min(kNear, by_distance.size()); ++i) {
      Shape& shape = shapes_[by_distance[i].second];
      Points points = shape.hull.vertices;
      points.insert(points.end(), added.vertices.begin(), added.vertices.end());
      std::optional<TriangleMesh> hull = HullOf(points);
      if (!hull) continue;
      *hull = ReducedHull(*hull, limits_.max_vertices);
      const double depth_m = ConcavityOf(*hull, *solid_).depth_m;
      if (depth_m >= least_m) continue;
      least_m = depth_m;
      best = std::move(hull);
      grown = &shape;
    }
    if (grown != nullptr) *grown = ShapeOf(*std::move(best));
  }

  const DistanceGrid* solid_;
  CoverLimits limits_;
  std::vector<Shape> shapes_;
};

}  // namespace

std::vector<TriangleMesh> Covering(std::vector<TriangleMesh> parts, const ClosedMesh& mesh,
                                   const DistanceGrid& solid, const CoverLimits& limits) {
  return Cover(std::move(parts), solid, limits).Over(mesh);
}

}  // namespace doorforge

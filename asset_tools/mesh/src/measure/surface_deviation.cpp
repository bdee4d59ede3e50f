// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/surface_deviation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"

#include "measure/surface_samples.h"
#include "measure/triangle_tree.h"

namespace doorforge {
namespace {

// Directions spread evenly over the sphere: a Fibonacci lattice.
std::vector<Eigen::Vector3d> Directions(int count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count;
    const double radius = std::sqrt(1 - z * z);
    directions.emplace_back(radius * std::cos(golden * i), radius * std::sin(golden * i), z);
  }
  return directions;
}

bool IsVisible(const TriangleTree& tree, const Eigen::Vector3d& point,
               const std::vector<Eigen::Vector3d>& directions, double gap_m) {
  return std::any_of(directions.begin(), directions.end(), [&](const Eigen::Vector3d& direction) {
    return !tree.Hits(point, direction, gap_m);
  });
}

// Up to about `count` of the vertices that triangles use, evenly picked in their order.
std::vector<Eigen::Vector3d> SomeVertices(const TriangleMesh& mesh, int count) {
  std::vector<char> is_used(mesh.vertices.size(), 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const int index : t) is_used[static_cast<std::size_t>(index)] = 1;
  }
  const std::size_t step = mesh.vertices.size() / static_cast<std::size_t>(std::max(1, count)) + 1;
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) {
    if (is_used[i]) vertices.push_back(mesh.vertices[i]);
  }
  return vertices;
}

std::vector<double> Distances(const std::vector<Eigen::Vector3d>& points, const TriangleTree& to,
                              const std::function<bool(const Eigen::Vector3d&)>& counts) {
  std::vector<double> distances;
  for (const Eigen::Vector3d& point : points) {
    if (counts(point)) distances.push_back(to.Distance(point));
  }
  return distances;
}

}  // namespace

SurfaceDeviation DeviationOf(const TriangleMesh& from, const TriangleMesh& to,
                             const DeviationSampling& sampling) {
  Require(!to.triangles.empty(), ErrorCode::kInvalidArgument,
          "a deviation needs a surface to measure to");
  const MeshTopology topology = MeasureTopology(from);
  MeasureTopology(to);  // for its checks of the indices
  const TriangleTree from_tree(from);
  const TriangleTree to_tree(to);
  const std::vector<Eigen::Vector3d> directions = Directions(std::max(1, sampling.rays));
  // far enough to leave the triangles that the point itself lies on
  const double gap_m = from.triangles.empty() ? 0 : 1e-6 * topology.bounds.diagonal().norm();
  const auto counts = [&](const Eigen::Vector3d& point) {
    return !sampling.visible_only || IsVisible(from_tree, point, directions, gap_m);
  };
  const std::vector<double> spread =
      Distances(SurfaceSamples(from, sampling.samples), to_tree, counts);
  if (spread.empty()) return {};
  const std::vector<double> corners =
      Distances(SomeVertices(from, sampling.samples), to_tree, counts);
  SurfaceDeviation deviation;
  deviation.samples = static_cast<int>(spread.size());
  deviation.mean_m = std::accumulate(spread.begin(), spread.end(), 0.0) / deviation.samples;
  deviation.max_m = *std::max_element(spread.begin(), spread.end());
  for (const double distance : corners) deviation.max_m = std::max(deviation.max_m, distance);
  return deviation;
}

}  // namespace doorforge

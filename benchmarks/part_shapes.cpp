// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "part_shapes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Triangle = std::array<Eigen::Vector3d, 3>;

// Evenly over the area: the i-th point lies at (i + 0.5) / n of the running area, at a random place
// of its triangle.
Points SampledSurface(const std::vector<Triangle>& triangles) {
  std::vector<double> running;
  double area = 0;
  for (const auto& [a, b, c] : triangles)
    running.push_back(area += 0.5 * (b - a).cross(c - a).norm());
  Points points(kShapePoints, 3);
  Rng rng(0, "diversity");
  for (int i = 0; i < kShapePoints; ++i) {
    const double at = (i + 0.5) / kShapePoints * area;
    const auto index = static_cast<std::size_t>(
        std::upper_bound(running.begin(), running.end() - 1, at) - running.begin());
    const auto& [a, b, c] = triangles[index];
    double u = rng.Uniform();
    double v = rng.Uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    points.row(i) = (a + u * (b - a) + v * (c - a)).transpose();
  }
  return points;
}

double MeanDistance(const Points& from, const PointTree& to, int stride) {
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < from.rows(); i += stride, ++count) {
    const std::array<double, 3> point = {from(i, 0), from(i, 1), from(i, 2)};
    Eigen::Index index = 0;
    double squared = 0;
    to.index->knnSearch(point.data(), 1, &index, &squared);
    sum += std::sqrt(squared);
  }
  return sum / count;
}

double SquaredDistanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0;
  return (p - a - t * along).squaredNorm();
}

double SquaredDistance(const Eigen::Vector3d& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const auto left_of = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (to - from).cross(p - from).dot(normal) >= 0;
  };
  if (normal.squaredNorm() > 0 && left_of(a, b) && left_of(b, c) && left_of(c, a)) {
    const double height = (p - a).dot(normal);
    return height * height / normal.squaredNorm();
  }
  return std::min({SquaredDistanceToSegment(p, a, b), SquaredDistanceToSegment(p, b, c),
                   SquaredDistanceToSegment(p, c, a)});
}

double MeanDistanceToSurface(const Points& from, const std::vector<Triangle>& to) {
  constexpr int kQueries = 256;
  double sum = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Eigen::Vector3d point = from.row(i * (kShapePoints / kQueries)).transpose();
    double nearest = 1e300;
    for (const Triangle& triangle : to)
      nearest = std::min(nearest, SquaredDistance(point, triangle));
    sum += std::sqrt(nearest);
  }
  return sum / kQueries;
}

}  // namespace

PartShape ShapeOf(const Part& part, const std::string& piece_name) {
  PartShape shape{part.id, {}, {}, nullptr};
  Eigen::AlignedBox3d box;
  for (const PartPiece& piece : part.pieces) {
    if (!piece_name.empty() && piece.name != piece_name) continue;
    for (const Eigen::Vector3i& t : piece.mesh.triangles) {
      Triangle& corners = shape.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const int vertex = t[static_cast<Eigen::Index>(k)];
        corners[k] = piece.mesh.vertices[static_cast<std::size_t>(vertex)];
        box.extend(corners[k]);
      }
    }
  }
  Require(!shape.triangles.empty(), ErrorCode::kMissing, part.id + ": no piece " + piece_name);
  const Eigen::Vector3d center = box.center();
  const double diagonal = box.diagonal().norm();
  for (Triangle& triangle : shape.triangles) {
    for (Eigen::Vector3d& corner : triangle) corner = (corner - center) / diagonal;
  }
  shape.points = SampledSurface(shape.triangles);
  return shape;
}

std::vector<fs::path> PartFolders(const fs::path& root) {
  Require(fs::is_directory(root), ErrorCode::kMissing, root.string() + ": no such folder");
  std::vector<fs::path> parts;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().filename() == "part.json") parts.push_back(entry.path().parent_path());
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

void BuildTree(PartShape& shape) {
  shape.tree = std::make_unique<PointTree>(3, std::cref(shape.points));
}

double Chamfer(const PartShape& a, const PartShape& b, int stride) {
  return 0.5 * (MeanDistance(a.points, *b.tree, stride) + MeanDistance(b.points, *a.tree, stride));
}

bool SameSurface(const PartShape& a, const PartShape& b, double tolerance) {
  return MeanDistanceToSurface(a.points, b.triangles) <= tolerance &&
         MeanDistanceToSurface(b.points, a.triangles) <= tolerance;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/surface_samples.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace doorforge {
namespace {

std::array<Eigen::Vector3d, 3> CornersOf(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  return {mesh.vertices[static_cast<std::size_t>(t[0])],
          mesh.vertices[static_cast<std::size_t>(t[1])],
          mesh.vertices[static_cast<std::size_t>(t[2])]};
}

double AreaOf(const std::array<Eigen::Vector3d, 3>& corner) {
  return 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
}

// Point number `i` of a sequence that fills a triangle evenly (Roberts' R2, folded).
Eigen::Vector3d PointIn(const std::array<Eigen::Vector3d, 3>& corner, double i) {
  double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0);
  double v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]);
}

}  // namespace

std::vector<Eigen::Vector3d> SurfaceSamples(const TriangleMesh& mesh, int count) {
  double area = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) area += AreaOf(CornersOf(mesh, t));
  std::vector<Eigen::Vector3d> samples;
  if (!(area > 0)) return samples;
  const double step = area / count;
  double due = 0.5 * step;  // area at which the next point comes
  double passed = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = CornersOf(mesh, t);
    passed += AreaOf(corner);
    for (; due < passed; due += step)
      samples.push_back(PointIn(corner, static_cast<double>(samples.size())));
  }
  return samples;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "smooth_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

namespace doorforge {
namespace {

// For each vertex the number of its position; positions are numbered in sorted order.
std::vector<std::size_t> PositionNumbers(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<std::size_t> order(vertices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(vertices[a].begin(), vertices[a].end(), vertices[b].begin(),
                                        vertices[b].end());
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<std::size_t> number(vertices.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
    number[order[i]] = number[order[i - 1]] + (less(order[i - 1], order[i]) ? 1 : 0);
  return number;
}

Eigen::Vector3d AreaNormal(const TriangleMesh& mesh, const Eigen::Vector3i& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
  const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(triangle[1])];
  const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(triangle[2])];
  return (b - a).cross(c - a);
}

}  // namespace

std::vector<std::array<Eigen::Vector3f, 3>> SmoothNormals(const TriangleMesh& mesh,
                                                          double crease_rad) {
  const std::vector<std::size_t> position = PositionNumbers(mesh.vertices);
  std::vector<Eigen::Vector3d> face;
  std::vector<std::vector<std::size_t>> faces_at(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    face.push_back(AreaNormal(mesh, mesh.triangles[i]));
    for (const int vertex : mesh.triangles[i])
      faces_at[position[static_cast<std::size_t>(vertex)]].push_back(i);
  }
  const double crease = std::cos(crease_rad);
  std::vector<std::array<Eigen::Vector3f, 3>> normals(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3d own = face[i].normalized();
    for (int corner = 0; corner < 3; ++corner) {
      const auto vertex = static_cast<std::size_t>(mesh.triangles[i][corner]);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const std::size_t other : faces_at[position[vertex]]) {
        if (face[other].normalized().dot(own) >= crease) sum += face[other];
      }
      const bool usable = sum.squaredNorm() > 0;
      normals[i][static_cast<std::size_t>(corner)] =
          (usable ? Eigen::Vector3d(sum.normalized()) : own).cast<float>();
    }
  }
  return normals;
}

}  // namespace doorforge

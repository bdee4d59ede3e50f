// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/thicken_sheet.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "measure/mesh_pieces.h"

namespace doorforge {
namespace {

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// For each vertex the way it goes when the planes of its triangles all move outwards by 1: least
// squares weighted by angle, the shortest where the planes leave a choice.
std::vector<Eigen::Vector3d> UnitShifts(const TriangleMesh& mesh) {
  constexpr double kShort = 1e-3;
  constexpr double kFarthest = 3;
  std::vector<Eigen::Matrix3d> planes(mesh.vertices.size(), Eigen::Matrix3d::Zero());
  std::vector<Eigen::Vector3d> sums(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(t[k]);
      const Eigen::Vector3d& a = mesh.vertices[at];
      const Eigen::Vector3d ab = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])] - a;
      const Eigen::Vector3d ac = mesh.vertices[static_cast<std::size_t>(t[(k + 2) % 3])] - a;
      const Eigen::Vector3d normal = ab.cross(ac).normalized();
      if (!normal.allFinite()) continue;
      const double weight = AngleBetween(ab, ac);
      planes[at] += weight * normal * normal.transpose();
      sums[at] += weight * normal;
    }
  }
  std::vector<Eigen::Vector3d> shifts;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Eigen::Matrix3d damped =
        planes[i] + (kShort * planes[i].trace() + 1e-12) * Eigen::Matrix3d::Identity();
    Eigen::Vector3d shift = damped.ldlt().solve(sums[i]);
    if (shift.norm() > kFarthest) shift *= kFarthest / shift.norm();
    shifts.push_back(shift);
  }
  return shifts;
}

Eigen::Vector3d NormalOf(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  return (mesh.vertices[static_cast<std::size_t>(t[1])] - a)
      .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a)
      .normalized();
}

Eigen::Vector3d CenterOf(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int index : t) sum += mesh.vertices[static_cast<std::size_t>(index)];
  return sum / 3;
}

// A number for each triangle; two at a blunt edge have the same.
std::vector<std::size_t> SmoothParts(const TriangleMesh& mesh) {
  constexpr double kBlunt = 0.866;  // cosine
  std::map<std::pair<int, int>, std::size_t> triangle_at;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) triangle_at[{t[k], t[(k + 1) % 3]}] = i;
  }
  const std::size_t none = mesh.triangles.size();
  std::vector<std::size_t> part(mesh.triangles.size(), none);
  for (std::size_t first = 0; first < part.size(); ++first) {
    if (part[first] != none) continue;
    part[first] = first;
    std::vector<std::size_t> pending = {first};
    while (!pending.empty()) {
      const Eigen::Vector3i t = mesh.triangles[pending.back()];
      pending.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto next = triangle_at.find({t[(k + 1) % 3], t[k]});
        if (next == triangle_at.end() || part[next->second] != none) continue;
        if (NormalOf(mesh, t).dot(NormalOf(mesh, mesh.triangles[next->second])) < kBlunt) continue;
        part[next->second] = first;
        pending.push_back(next->second);
      }
    }
  }
  return part;
}

// 0 or 1 for each triangle: below or above the middle of the longest extent.
std::vector<std::size_t> Halves(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& t : mesh.triangles) box.extend(CenterOf(mesh, t));
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::vector<std::size_t> half;
  for (const Eigen::Vector3i& t : mesh.triangles)
    half.push_back(CenterOf(mesh, t)[axis] > box.center()[axis]);
  return half;
}

}  // namespace

std::vector<TriangleMesh> Patches(const TriangleMesh& surface) {
  std::vector<std::size_t> part = SmoothParts(surface);
  if (std::all_of(part.begin(), part.end(), [](std::size_t p) { return p == 0; }))
    part = Halves(surface);
  std::map<std::size_t, TriangleMesh> patches;
  for (std::size_t i = 0; i < part.size(); ++i) {
    TriangleMesh& patch = patches[part[i]];
    patch.vertices = surface.vertices;
    patch.triangles.push_back(surface.triangles[i]);
  }
  std::vector<TriangleMesh> pieces;
  for (auto& [number, patch] : patches) {
    // triangles of one patch that hang together by their edges
    for (TriangleMesh& piece : PiecesOf(patch)) pieces.push_back(std::move(piece));
  }
  return pieces;
}

TriangleMesh Offset(const TriangleMesh& mesh, double distance_m) {
  const std::vector<Eigen::Vector3d> shifts = UnitShifts(mesh);
  TriangleMesh moved = mesh;
  for (std::size_t i = 0; i < shifts.size(); ++i) moved.vertices[i] += distance_m * shifts[i];
  return moved;
}

TriangleMesh Thickened(const TriangleMesh& sheet, double distance_m) {
  const TriangleMesh below = Offset(sheet, -distance_m);
  TriangleMesh solid = Offset(sheet, distance_m);
  const int count = static_cast<int>(sheet.vertices.size());
  solid.vertices.insert(solid.vertices.end(), below.vertices.begin(), below.vertices.end());
  std::set<std::pair<int, int>> edges;
  for (const Eigen::Vector3i& t : sheet.triangles) {
    solid.triangles.emplace_back(t[0] + count, t[2] + count, t[1] + count);
    for (int k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
  }
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;
    solid.triangles.emplace_back(b, a, a + count);
    solid.triangles.emplace_back(b, a + count, b + count);
  }
  return solid;
}

}  // namespace doorforge

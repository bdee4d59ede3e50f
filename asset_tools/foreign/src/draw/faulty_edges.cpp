// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/faulty_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "check/mesh_measures.h"

namespace doorforge::foreign {
namespace {

using Corners = std::array<int, 3>;

/// How the triangles run through an edge.
struct EdgeUse {
  int forward = 0;  // from the lower number to the higher
  int backward = 0;
};

Corners Sorted(const Eigen::Vector3i& triangle) {
  Corners corners = {triangle[0], triangle[1], triangle[2]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

bool RepeatsCorner(const Corners& sorted) {
  return sorted[0] == sorted[1] || sorted[1] == sorted[2];
}

bool HasNoArea(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  const auto at = [&](int k) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(t[k])];
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).squaredNorm() == 0;
}

std::map<std::array<int, 2>, EdgeUse> UsesOf(const TriangleMesh& mesh) {
  std::map<std::array<int, 2>, EdgeUse> uses;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (RepeatsCorner(Sorted(t))) continue;
    for (int k = 0; k < 3; ++k) {
      const int from = t[k];
      const int to = t[(k + 1) % 3];
      EdgeUse& use = uses[{std::min(from, to), std::max(from, to)}];
      ++(from < to ? use.forward : use.backward);
    }
  }
  return uses;
}

bool IsCounted(const EdgeUse& use, std::string_view code) {
  const int all = use.forward + use.backward;
  if (code == "GEO009") return all == 1;
  if (code == "GEO017") return all > 2;
  return all == 2 && use.forward != 1;  // GEO010
}

/// The triangles that GEO011 or GEO012 counts.
std::vector<Eigen::Vector3i> CountedTriangles(const TriangleMesh& welded, std::string_view code) {
  std::vector<Eigen::Vector3i> counted;
  std::set<Corners> seen;
  for (const Eigen::Vector3i& t : welded.triangles) {
    const Corners corners = Sorted(t);
    const bool repeated = !seen.insert(corners).second;
    const bool flat = RepeatsCorner(corners) || HasNoArea(welded, t);
    if (code == "GEO012" ? repeated : flat) counted.push_back(t);
  }
  return counted;
}

}  // namespace

std::vector<Edge> FaultyEdges(const TriangleMesh& mesh, std::string_view code, std::size_t most) {
  static constexpr std::string_view kCodes[] = {"GEO009", "GEO010", "GEO011", "GEO012", "GEO017"};
  if (std::find(std::begin(kCodes), std::end(kCodes), code) == std::end(kCodes)) return {};
  TriangleMesh welded = Welded(mesh);
  std::vector<Edge> edges;
  const auto add = [&](int from, int to) {
    if (edges.size() < most)
      edges.push_back({welded.vertices[static_cast<std::size_t>(from)],
                       welded.vertices[static_cast<std::size_t>(to)]});
  };
  if (code == "GEO011" || code == "GEO012") {
    for (const Eigen::Vector3i& t : CountedTriangles(welded, code)) {
      for (int k = 0; k < 3; ++k) add(t[k], t[(k + 1) % 3]);
    }
    return edges;
  }
  DropRepeated(welded);
  for (const auto& [ends, use] : UsesOf(welded)) {
    if (IsCounted(use, code)) add(ends[0], ends[1]);
  }
  return edges;
}

namespace {

TriangleMesh Clustered(const TriangleMesh& mesh, const Eigen::AlignedBox3d& bounds, double cells) {
  const double cell = std::max(bounds.sizes().maxCoeff() / cells, 1e-12);
  TriangleMesh coarse;
  std::map<std::array<long, 3>, int> number_of;
  std::vector<int> index_of(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d at = (mesh.vertices[i] - bounds.min()) / cell;
    const std::array<long, 3> key = {std::lround(at.x()), std::lround(at.y()), std::lround(at.z())};
    const auto [entry, is_new] = number_of.emplace(key, static_cast<int>(coarse.vertices.size()));
    if (is_new) coarse.vertices.push_back(mesh.vertices[i]);
    index_of[i] = entry->second;
  }
  std::set<Corners> seen;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto at = [&](int k) { return index_of[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3i moved(at(0), at(1), at(2));
    const Corners corners = Sorted(moved);
    if (!RepeatsCorner(corners) && seen.insert(corners).second) coarse.triangles.push_back(moved);
  }
  return coarse;
}

}  // namespace

TriangleMesh Coarser(const TriangleMesh& mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) return mesh;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  for (double cells = 512;; cells /= 1.5) {
    TriangleMesh coarse = Clustered(mesh, bounds, cells);
    if (coarse.triangles.size() <= most || cells < 4) return coarse;
  }
}

}  // namespace doorforge::foreign

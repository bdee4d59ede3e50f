// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"

#include "convex/exact_side.h"
#include "convex/growing_hull.h"
#include "measure/mesh_pieces.h"

namespace doorforge {
namespace {

const Eigen::Vector3d& At(const TriangleMesh& mesh, int index) {
  return mesh.vertices[static_cast<std::size_t>(index)];
}

using Edge = std::pair<int, int>;

// For each triangle the first one of its facet: triangles in one plane, joined across edges.
std::vector<std::size_t> FacetOfTriangles(const TriangleMesh& hull) {
  std::map<Edge, std::size_t> triangle_at;
  for (std::size_t i = 0; i < hull.triangles.size(); ++i) {
    const Eigen::Vector3i& t = hull.triangles[i];
    for (int k = 0; k < 3; ++k) triangle_at[{t[k], t[(k + 1) % 3]}] = i;
  }
  std::vector<std::size_t> facet(hull.triangles.size(), hull.triangles.size());
  for (std::size_t first = 0; first < facet.size(); ++first) {
    if (facet[first] != facet.size()) continue;
    facet[first] = first;
    std::vector<std::size_t> pending = {first};
    while (!pending.empty()) {
      const Eigen::Vector3i t = hull.triangles[pending.back()];
      pending.pop_back();
      for (int k = 0; k < 3; ++k) {
        const std::size_t next = triangle_at.at({t[(k + 1) % 3], t[k]});
        if (facet[next] != facet.size()) continue;
        const bool in_plane = [&] {
          const Eigen::Vector3i& other = hull.triangles[next];
          return std::all_of(other.begin(), other.end(), [&](int corner) {
            return SideOfPlane(At(hull, t[0]), At(hull, t[1]), At(hull, t[2]), At(hull, corner)) ==
                   0;
          });
        }();
        if (!in_plane) continue;
        facet[next] = first;
        pending.push_back(next);
      }
    }
  }
  return facet;
}

// The convex polygon around each facet, from its smallest vertex, without vertices that lie within
// an edge (where only two facets meet).
std::vector<std::vector<int>> FacetPolygons(const TriangleMesh& hull) {
  const std::vector<std::size_t> facet = FacetOfTriangles(hull);
  std::map<Edge, std::size_t> facet_at;
  std::map<int, std::set<std::size_t>> facets_around;
  for (std::size_t i = 0; i < facet.size(); ++i) {
    const Eigen::Vector3i& t = hull.triangles[i];
    for (int k = 0; k < 3; ++k) {
      facet_at[{t[k], t[(k + 1) % 3]}] = facet[i];
      facets_around[t[k]].insert(facet[i]);
    }
  }
  std::map<std::size_t, std::map<int, int>> next_around;
  for (const auto& [edge, at] : facet_at) {
    if (facet_at.at({edge.second, edge.first}) != at) next_around[at][edge.first] = edge.second;
  }
  std::vector<std::vector<int>> polygons;
  for (const auto& [at, next] : next_around) {
    std::vector<int> polygon;
    int vertex = next.begin()->first;
    do {
      if (facets_around[vertex].size() >= 3) polygon.push_back(vertex);
      vertex = next.at(vertex);
    } while (vertex != next.begin()->first);
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    polygons.push_back(std::move(polygon));
  }
  std::sort(polygons.begin(), polygons.end());
  return polygons;
}

// Which triangles a facet with more than three corners was made of depends on the order of the
// points. The facets themselves are unique: they are cut into fans here, in lexicographic order.
TriangleMesh CanonicalHull(const TriangleMesh& hull) {
  const TriangleMesh sorted = InVertexOrder(hull);
  TriangleMesh canonical;
  std::vector<int> new_index(sorted.vertices.size(), -1);
  const std::vector<std::vector<int>> polygons = FacetPolygons(sorted);
  std::set<int> used;
  for (const std::vector<int>& polygon : polygons) used.insert(polygon.begin(), polygon.end());
  for (const int vertex : used) {
    new_index[static_cast<std::size_t>(vertex)] = static_cast<int>(canonical.vertices.size());
    canonical.vertices.push_back(sorted.vertices[static_cast<std::size_t>(vertex)]);
  }
  const auto at = [&](int vertex) { return new_index[static_cast<std::size_t>(vertex)]; };
  for (const std::vector<int>& polygon : polygons) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      canonical.triangles.emplace_back(at(polygon[0]), at(polygon[i]), at(polygon[i + 1]));
  }
  return canonical;
}

}  // namespace

TriangleMesh ConvexHull(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points)
    Require(point.allFinite(), ErrorCode::kInvalidArgument,
            "a point of a convex hull is not finite");
  const std::optional<TriangleMesh> hull = GrownHull(points, 0);
  Require(hull.has_value(), ErrorCode::kInvalidArgument,
          "the points of a convex hull lie in one plane");
  return CanonicalHull(*hull);
}

}  // namespace doorforge

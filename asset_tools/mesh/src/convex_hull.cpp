// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/mesh/work_budget.h"

#include "exact_side.h"
#include "mesh_pieces.h"

namespace doorforge {
namespace {

const Eigen::Vector3d& At(const TriangleMesh& mesh, int index) {
  return mesh.vertices[static_cast<std::size_t>(index)];
}

// ---- the hull ---------------------------------------------------------------------------------

constexpr int kNoFacet = -1;

/// A triangle of the growing hull, and the points that are above it and above no triangle before.
struct HullFace {
  std::array<int, 3> corners{};
  std::array<int, 3> beside{};  // across the edge from each corner to the next
  std::vector<int> above;
  bool gone = false;
};

/// Quickhull (Barber, Dobkin and Huhdanpaa, 1996) with exact predicates: no triangle is ever on the
/// wrong side of a point, and points in a triangle's plane are no trouble.
class GrowingHull {
 public:
  explicit GrowingHull(std::span<const Eigen::Vector3d> points) : points_(points) {}

  /// Nothing if the points lie in one plane.
  std::optional<TriangleMesh> Grow() {
    if (!Begin()) return std::nullopt;
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      if (!faces_[face].gone && !faces_[face].above.empty()) Add(static_cast<int>(face));
    }
    return Mesh();
  }

 private:
  const Eigen::Vector3d& Point(int index) const { return points_[static_cast<std::size_t>(index)]; }
  HullFace& Face(int index) { return faces_[static_cast<std::size_t>(index)]; }

  int SideOf(const HullFace& face, int point) const {
    return SideOfPlane(Point(face.corners[0]), Point(face.corners[1]), Point(face.corners[2]),
                       Point(point));
  }

  // the first point of which `fits` says so
  template <class Fits>
  int Find(const Fits& fits) const {
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      if (fits(i)) return i;
    }
    return kNoFacet;
  }

  bool Begin() {
    if (points_.empty()) return false;
    const int a = 0;
    const int b = Find([&](int i) { return Point(i) != Point(a); });
    if (b == kNoFacet) return false;
    const int c = Find([&](int i) { return !AreCollinear(Point(a), Point(b), Point(i)); });
    if (c == kNoFacet) return false;
    const auto side = [&](int i) { return SideOfPlane(Point(a), Point(b), Point(c), Point(i)); };
    const int d = Find([&](int i) { return side(i) != 0; });
    if (d == kNoFacet) return false;
    const std::array<int, 4> k =
        side(d) < 0 ? std::array{a, b, c, d} : std::array{a, c, b, d};  // d is below the first
    faces_ = {{{k[0], k[1], k[2]}, {1, 2, 3}, {}},
              {{k[1], k[0], k[3]}, {0, 3, 2}, {}},
              {{k[2], k[1], k[3]}, {0, 1, 3}, {}},
              {{k[0], k[2], k[3]}, {0, 2, 1}, {}}};
    std::vector<int> all(points_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    Spread(all, 0);
    return true;
  }

  // Gives each point to the first face from `first` on that it is above of; others are inside.
  void Spread(const std::vector<int>& points, std::size_t first) {
    for (const int point : points) {
      CheckWork(10);
      for (std::size_t face = first; face < faces_.size(); ++face) {
        if (SideOf(faces_[face], point) <= 0) continue;
        faces_[face].above.push_back(point);
        break;
      }
    }
  }

  int Farthest(const HullFace& face) const {
    const Eigen::Vector3d& corner = Point(face.corners[0]);
    const Eigen::Vector3d normal =
        (Point(face.corners[1]) - corner).cross(Point(face.corners[2]) - corner);
    int best = face.above[0];
    double most = -1;
    for (const int point : face.above) {
      const double height = normal.dot(Point(point) - corner);
      if (height > most) {
        most = height;
        best = point;
      }
    }
    return best;
  }

  // Takes away what `apex` sees, and puts a cone in its place.
  void Add(int start) {
    const int apex = Farthest(Face(start));
    std::vector<int> seen = {start};
    Face(start).gone = true;
    std::vector<std::array<int, 3>> rim;  // edge, and the face that stays beside it
    std::vector<int> loose;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const HullFace face = std::move(Face(seen[i]));
      Face(seen[i]).gone = true;
      for (const int point : face.above) {
        if (point != apex) loose.push_back(point);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const int next = face.beside[k];
        if (Face(next).gone) continue;
        if (SideOf(Face(next), apex) > 0) {
          Face(next).gone = true;
          seen.push_back(next);
        } else {
          rim.push_back({face.corners[k], face.corners[(k + 1) % 3], next});
        }
      }
    }
    Spread(loose, AddCone(rim, apex));
  }

  // Gives the number of the first new face.
  std::size_t AddCone(const std::vector<std::array<int, 3>>& rim, int apex) {
    const std::size_t first = faces_.size();
    std::map<int, int> face_from;  // by the corner at which its edge of the rim begins
    for (const auto& [from, to, stays] : rim) {
      const int number = static_cast<int>(faces_.size());
      face_from[from] = number;
      HullFace& neighbour = Face(stays);
      for (std::size_t k = 0; k < 3; ++k) {
        if (neighbour.corners[k] == to && neighbour.corners[(k + 1) % 3] == from)
          neighbour.beside[k] = number;
      }
      faces_.push_back({{from, to, apex}, {stays, kNoFacet, kNoFacet}, {}});
    }
    for (std::size_t i = first; i < faces_.size(); ++i) {
      const int next = face_from.at(faces_[i].corners[1]);
      faces_[i].beside[1] = next;
      Face(next).beside[2] = static_cast<int>(i);
    }
    return first;
  }

  TriangleMesh Mesh() const {
    TriangleMesh mesh;
    std::vector<int> number(points_.size(), kNoFacet);
    for (const HullFace& face : faces_) {
      if (face.gone) continue;
      Eigen::Vector3i triangle;
      for (int k = 0; k < 3; ++k) {
        const int point = face.corners[static_cast<std::size_t>(k)];
        int& at = number[static_cast<std::size_t>(point)];
        if (at == kNoFacet) {
          at = static_cast<int>(mesh.vertices.size());
          mesh.vertices.push_back(Point(point));
        }
        triangle[k] = at;
      }
      mesh.triangles.push_back(triangle);
    }
    return mesh;
  }

  std::span<const Eigen::Vector3d> points_;
  std::vector<HullFace> faces_;
};

// ---- one triangulation for one hull -----------------------------------------------------------

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
  const std::optional<TriangleMesh> hull = GrowingHull(points).Grow();
  Require(hull.has_value(), ErrorCode::kInvalidArgument,
          "the points of a convex hull lie in one plane");
  return CanonicalHull(*hull);
}

}  // namespace doorforge

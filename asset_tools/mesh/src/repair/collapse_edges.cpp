// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/collapse_edges.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <tuple>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "doorforge/mesh/work_budget.h"

#include "repair/box_octree.h"
#include "repair/triangle_crossing.h"

namespace doorforge {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLengthWeight = 1e-8;  // of squared lengths: in planes the shortest edges go first
constexpr double kStay = 1e-5;          // of the quadric: what no plane holds stays at the middle
constexpr double kLeastCosine = 0.2;    // of the angle that a triangle may turn by
constexpr double kLeastArea = 1e-4;     // doubled, of the squared longest side: flatter is a line

// The sum of squared distances to planes: x A x + 2 b x + c.
struct Quadric {
  Matrix3d a = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double c = 0;

  void AddPlane(const Vector3d& normal, const Vector3d& at) {
    const double d = -normal.dot(at);
    a += normal * normal.transpose();
    b += d * normal;
    c += d * d;
  }
  Quadric& operator+=(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    return *this;
  }
  double At(const Vector3d& x) const { return std::max(0.0, x.dot(a * x) + 2 * b.dot(x) + c); }
};

struct Collapse {
  double key = 0;  // the error, and a little for the length
  int kept = 0, gone = 0;
  std::uint32_t kept_stamp = 0, gone_stamp = 0;  // it counts only while its ends have these

  // The cheapest comes first out of a heap; of equal ones the first by number.
  bool operator<(const Collapse& other) const {
    return std::tie(other.key, other.kept, other.gone) < std::tie(key, kept, gone);
  }
};

enum class Crossings { kMayArise, kAreRefused };

class CollapsingSurface {
 public:
  CollapsingSurface(const TriangleMesh& mesh, Crossings crossings)
      : triangles_(mesh.triangles), alive_(mesh.triangles.size(), 1) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
    if (!mesh.vertices.empty()) origin_ = box.center();
    for (const Vector3d& vertex : mesh.vertices) {
      vertices_.emplace_back().at = vertex - origin_;
      vertices_.back().in_mesh = vertex;
    }
    count_ = static_cast<int>(triangles_.size());
    for (int t = 0; t < count_; ++t) {
      const Vector3d doubled = Doubled(Corners(t));
      const double area = doubled.norm();
      for (const int v : triangles_[Index(t)]) {
        VertexOf(v).around.push_back(t);
        if (area > 0) VertexOf(v).quadric.AddPlane(doubled / area, VertexOf(v).at);
      }
    }
    for (const Eigen::Vector3i& t : triangles_) {
      for (int k = 0; k < 3; ++k) {
        // of a closed surface each edge comes once in either direction
        if (t[k] < t[(k + 1) % 3]) heap_.push_back(CollapseOf(t[k], t[(k + 1) % 3]));
      }
    }
    std::make_heap(heap_.begin(), heap_.end());
    if (crossings == Crossings::kMayArise || mesh.vertices.empty()) return;
    places_.emplace(box, triangles_.size());
    for (int t = 0; t < count_; ++t) places_->Put(Index(t), BoxOf(InMesh(t)));
  }

  void Reduce(int max_triangles, double max_cost) {
    while (!heap_.empty()) {
      const Collapse next = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
      const Vertex& kept = VertexOf(next.kept);
      const Vertex& gone = VertexOf(next.gone);
      if (kept.stamp != next.kept_stamp || gone.stamp != next.gone_stamp) continue;
      if (count_ <= max_triangles && next.key > max_cost) return;
      CheckWork(50);
      const Vector3d to = PlaceOf(next.kept, next.gone);
      if (KeepsTopology(next.kept, next.gone) && TurnsNothing(next.kept, next.gone, to) &&
          TurnsNothing(next.gone, next.kept, to) &&
          (!places_ || CrossesNothing(next.kept, next.gone, to))) {
        Carry(next.kept, next.gone, to);
      } else {
        VertexOf(next.kept).refused = VertexOf(next.gone).refused = true;
      }
    }
  }

  TriangleMesh Mesh() const {
    TriangleMesh mesh;
    std::vector<int> index(vertices_.size(), -1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!alive_[t]) continue;
      Eigen::Vector3i triangle = triangles_[t];
      for (int& corner : triangle) {
        int& at = index[Index(corner)];
        if (at < 0) {
          at = static_cast<int>(mesh.vertices.size());
          mesh.vertices.push_back(VertexOf(corner).in_mesh);
        }
        corner = at;
      }
      mesh.triangles.push_back(triangle);
    }
    return mesh;
  }

 private:
  struct Vertex {
    Vector3d at = Vector3d::Zero();       // from the origin
    Vector3d in_mesh = Vector3d::Zero();  // as it comes out: to the bit the input's until it moves
    Quadric quadric;
    std::vector<int> around;  // triangles
    std::uint32_t stamp = 0;  // changes with place and quadric
    bool refused = false;     // a collapse of one of its edges was
  };
  using Three = std::array<Vector3d, 3>;

  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }
  Vertex& VertexOf(int v) { return vertices_[Index(v)]; }
  const Vertex& VertexOf(int v) const { return vertices_[Index(v)]; }

  Three Corners(int t) const {
    const Eigen::Vector3i& triangle = triangles_[Index(t)];
    return {VertexOf(triangle[0]).at, VertexOf(triangle[1]).at, VertexOf(triangle[2]).at};
  }
  static Vector3d Doubled(const Three& corners) {
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  }

  static double LongestSquared(const Three& corners) {
    return std::max({(corners[1] - corners[0]).squaredNorm(),
                     (corners[2] - corners[1]).squaredNorm(),
                     (corners[0] - corners[2]).squaredNorm()});
  }

  // The best place for both ends; where planes leave it free, as near to the middle as can be.
  Vector3d PlaceOf(int kept, int gone) const {
    const Vector3d& p = VertexOf(kept).at;
    const Vector3d& q = VertexOf(gone).at;
    Quadric both = VertexOf(kept).quadric;
    both += VertexOf(gone).quadric;
    const Vector3d middle = 0.5 * (p + q);
    const double stay = kStay * both.a.trace();
    const Matrix3d held = both.a + stay * Matrix3d::Identity();
    Vector3d best = held.ldlt().solve(stay * middle - both.b);
    // a place far off follows from planes that are nearly one
    if (!((best - middle).squaredNorm() <= (p - q).squaredNorm())) best = middle;
    for (const Vector3d& other : {middle, p, q}) {
      if (both.At(other) < both.At(best)) best = other;
    }
    return best;
  }

  Collapse CollapseOf(int a, int b) const {
    const auto [kept, gone] = std::minmax(a, b);
    const Vertex& p = VertexOf(kept);
    const Vertex& q = VertexOf(gone);
    const Vector3d to = PlaceOf(kept, gone);
    const double key =
        p.quadric.At(to) + q.quadric.At(to) + kLengthWeight * (p.at - q.at).squaredNorm();
    return {key, kept, gone, p.stamp, q.stamp};
  }

  void Push(const Collapse& collapse) {
    heap_.push_back(collapse);
    std::push_heap(heap_.begin(), heap_.end());
  }

  void NeighboursOf(int v, std::vector<int>& neighbours) const {
    neighbours.clear();
    for (const int t : VertexOf(v).around) {
      for (const int corner : triangles_[Index(t)]) {
        if (corner != v) neighbours.push_back(corner);
      }
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  }

  // The link condition (Dey et al. 1999): the ends share the two vertices across the edge alone,
  // and neither of those would be left with two triangles.
  bool KeepsTopology(int kept, int gone) {
    NeighboursOf(kept, near_);
    NeighboursOf(gone, near_other_);
    common_.clear();
    std::set_intersection(near_.begin(), near_.end(), near_other_.begin(), near_other_.end(),
                          std::back_inserter(common_));
    return common_.size() == 2 && VertexOf(common_[0]).around.size() > 3 &&
           VertexOf(common_[1]).around.size() > 3;
  }

  // Whether all triangles around `moved` but those at the edge keep their side and an area.
  bool TurnsNothing(int moved, int other, const Vector3d& to) const {
    for (const int t : VertexOf(moved).around) {
      const Eigen::Vector3i& triangle = triangles_[Index(t)];
      if (HasCorner(t, other)) continue;
      const Three before = Corners(t);
      Three after = before;
      for (std::size_t k = 0; k < 3; ++k) {
        if (triangle[static_cast<int>(k)] == moved) after[k] = to;
      }
      const Vector3d was = Doubled(before);
      const Vector3d is = Doubled(after);
      // a line has no side, and may stay one
      if (!(was.norm() > kLeastArea * LongestSquared(before))) continue;
      if (!(was.dot(is) > kLeastCosine * was.norm() * is.norm())) return false;
      if (!(is.norm() > kLeastArea * LongestSquared(after))) return false;
    }
    return true;
  }

  // A triangle as it is or will be, and the box around it.
  struct Placed {
    CornerTriangle triangle;
    Eigen::AlignedBox3d box;
  };

  // Whether the triangles around both ends, which become one at `to`, are then apart from each
  // other and from those that stay.
  bool CrossesNothing(int kept, int gone, const Vector3d& to) {
    moved_.clear();
    Eigen::AlignedBox3d reach;
    for (const int end : {kept, gone}) {
      for (const int t : VertexOf(end).around) {
        if (HasCorner(t, kept) && HasCorner(t, gone)) continue;
        CornerTriangle triangle = InMesh(t);
        for (std::size_t k = 0; k < 3; ++k) {
          if (triangle.corners[k] != end) continue;
          triangle.corners[k] = kept;
          triangle.points[k] = to + origin_;
        }
        if (IsLine(triangle)) return false;
        moved_.push_back({triangle, BoxOf(triangle)});
        reach.extend(moved_.back().box);
      }
    }
    CheckWork(static_cast<unsigned>(100 * moved_.size()));
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (TrianglesCross(moved_[i].triangle, moved_[k].triangle)) return false;
      }
    }
    still_.clear();
    places_->Find(reach, still_);
    return std::none_of(still_.begin(), still_.end(), [&](std::size_t number) {
      const auto t = static_cast<int>(number);
      if (HasCorner(t, kept) || HasCorner(t, gone)) return false;
      const CornerTriangle triangle = InMesh(t);
      const Eigen::AlignedBox3d box = BoxOf(triangle);
      return std::any_of(moved_.begin(), moved_.end(), [&](const Placed& one) {
        return one.box.intersects(box) && TrianglesCross(one.triangle, triangle);
      });
    });
  }

  bool HasCorner(int t, int v) const { return (triangles_[Index(t)].array() == v).any(); }

  CornerTriangle InMesh(int t) const {
    const Eigen::Vector3i& triangle = triangles_[Index(t)];
    return {{triangle[0], triangle[1], triangle[2]},
            {VertexOf(triangle[0]).in_mesh, VertexOf(triangle[1]).in_mesh,
             VertexOf(triangle[2]).in_mesh}};
  }

  static Eigen::AlignedBox3d BoxOf(const CornerTriangle& triangle) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& point : triangle.points) box.extend(point);
    return box;
  }

  void Carry(int kept, int gone, const Vector3d& to) {
    Vertex& stays = VertexOf(kept);
    Vertex& goes = VertexOf(gone);
    for (const int t : goes.around) {
      Eigen::Vector3i& triangle = triangles_[Index(t)];
      if (HasCorner(t, kept)) {
        Remove(t, gone);
        continue;
      }
      for (int& corner : triangle) corner = corner == gone ? kept : corner;
      stays.around.push_back(t);
    }
    goes.around.clear();
    ++goes.stamp;
    ++stays.stamp;
    stays.at = to;
    stays.in_mesh = to + origin_;
    if (places_) {
      for (const int t : stays.around) places_->Put(Index(t), BoxOf(InMesh(t)));
    }
    stays.quadric += goes.quadric;
    NeighboursOf(kept, near_);
    for (const int neighbour : near_) Push(CollapseOf(kept, neighbour));
    // what was refused beside it may now be possible
    for (const int neighbour : near_) {
      if (!VertexOf(neighbour).refused) continue;
      VertexOf(neighbour).refused = false;
      NeighboursOf(neighbour, near_other_);
      for (const int next : near_other_) {
        if (next != kept) Push(CollapseOf(neighbour, next));
      }
    }
  }

  void Remove(int t, int gone) {
    alive_[Index(t)] = 0;
    if (places_) places_->Remove(Index(t));
    --count_;
    for (const int corner : triangles_[Index(t)]) {
      if (corner != gone) std::erase(VertexOf(corner).around, t);
    }
  }

  Vector3d origin_ = Vector3d::Zero();  // near the vertices, so that quadrics round little
  std::vector<Vertex> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<char> alive_;  // for each triangle
  int count_ = 0;            // of triangles alive
  std::vector<Collapse> heap_;
  std::optional<BoxOctree> places_;  // of triangles alive, where crossings are refused
  // room for what is asked again and again
  std::vector<int> near_, near_other_, common_;
  std::vector<Placed> moved_;
  std::vector<std::size_t> still_;
};

TriangleMesh Collapsed(const TriangleMesh& mesh, int max_triangles, double free_error_m,
                       Crossings crossings) {
  CollapsingSurface surface(mesh, crossings);
  surface.Reduce(max_triangles, free_error_m * free_error_m);
  return surface.Mesh();
}

}  // namespace

TriangleMesh Reduced(const TriangleMesh& mesh, int max_triangles, double free_error_m) {
  return Collapsed(mesh, max_triangles, free_error_m, Crossings::kMayArise);
}

TriangleMesh ReducedWithoutCrossings(const TriangleMesh& mesh, int max_triangles,
                                     double free_error_m) {
  return Collapsed(mesh, max_triangles, free_error_m, Crossings::kAreRefused);
}

}  // namespace doorforge

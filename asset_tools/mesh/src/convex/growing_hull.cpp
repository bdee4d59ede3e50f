// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/growing_hull.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/mesh/work_budget.h"

#include "convex/exact_side.h"

namespace doorforge {
namespace {

constexpr int kNone = -1;

/// A triangle of the growing hull, and the points that are above it and above no triangle before.
struct HullFace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // as long as twice the area
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // the first corner
  double tolerance = 0;                              // of heights, which are as much too long
  std::array<int, 3> corners{};
  std::array<int, 3> beside{};                     // across the edge from each corner to the next
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // for the error of a height, see kSideBound
  int first_above = kNone;
  int highest = kNone;
  double most_above = 0;
  bool gone = false;
};

/// Quickhull (Barber, Dobkin and Huhdanpaa, 1996). Which triangles a point sees is told exactly, so
/// that the hull stays closed whatever is flat or touches; how high points are is rounded.
class GrowingHull {
 public:
  GrowingHull(std::span<const Eigen::Vector3d> points, double tolerance_m)
      : points_(points),
        tolerance_m_(tolerance_m),
        next_above_(points.size(), kNone),
        face_from_(points.size(), kNone) {}

  std::optional<TriangleMesh> Grow() {
    if (!Begin()) return std::nullopt;
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      if (!faces_[face].gone && faces_[face].highest != kNone) Add(static_cast<int>(face));
    }
    return Mesh();
  }

 private:
  const Eigen::Vector3d& Point(int index) const { return points_[static_cast<std::size_t>(index)]; }
  HullFace& Face(int index) { return faces_[static_cast<std::size_t>(index)]; }
  int Count() const { return static_cast<int>(points_.size()); }

  struct Height {
    double value;
    double error;
  };
  Height HeightOver(const HullFace& face, int point) const {
    const Eigen::Vector3d way = Point(point) - Point(face.corners[0]);
    return {face.normal.dot(way), kSideBound * face.size.dot(way.cwiseAbs())};
  }

  bool IsExactlyAbove(const HullFace& face, int point) const {
    return ExactSideOfPlane(Point(face.corners[0]), Point(face.corners[1]), Point(face.corners[2]),
                            Point(point)) > 0;
  }

  // whether the point sees the face
  bool IsAbove(const HullFace& face, int point) const {
    const Height height = HeightOver(face, point);
    if (std::abs(height.value) > height.error) return height.value > 0;
    return IsExactlyAbove(face, point);
  }

  // the point for which `measure` is most, the first of them; none where it is zero for all
  template <class Measure>
  int Farthest(const Measure& measure) const {
    int best = kNone;
    double most = 0;
    for (int i = 0; i < Count(); ++i) {
      const double value = measure(i);
      if (!(value > most)) continue;
      most = value;
      best = i;
    }
    return best;
  }

  // the first point of which `fits` says so
  template <class Fits>
  int Find(const Fits& fits) const {
    for (int i = 0; i < Count(); ++i) {
      if (fits(i)) return i;
    }
    return kNone;
  }

  // A large tetrahedron leaves few points outside. Where rounding makes the farthest point no
  // answer, any point does that is exactly off the line or the plane.
  bool Begin() {
    if (points_.empty()) return false;
    int a = 0;
    for (int i = 1; i < Count(); ++i) {
      if (Point(i).x() < Point(a).x()) a = i;
    }
    const int b = Farthest([&](int i) { return (Point(i) - Point(a)).squaredNorm(); });
    if (b == kNone) return false;
    const Eigen::Vector3d ab = Point(b) - Point(a);
    int c = Farthest([&](int i) { return ab.cross(Point(i) - Point(a)).squaredNorm(); });
    if (c == kNone || AreCollinear(Point(a), Point(b), Point(c)))
      c = Find([&](int i) { return !AreCollinear(Point(a), Point(b), Point(i)); });
    if (c == kNone) return false;
    const HullFace base = FaceOf(a, b, c);
    int d = Farthest([&](int i) { return std::abs(HeightOver(base, i).value); });
    const auto side = [&](int i) { return SideOfPlane(Point(a), Point(b), Point(c), Point(i)); };
    if (d == kNone || side(d) == 0) d = Find([&](int i) { return side(i) != 0; });
    if (d == kNone || std::abs(HeightOver(base, d).value) < base.tolerance) return false;
    BeginWith(side(d) < 0 ? std::array{a, b, c, d} : std::array{a, c, b, d});
    return true;
  }

  // The last corner is below the first three.
  void BeginWith(const std::array<int, 4>& k) {
    faces_ = {FaceOf(k[0], k[1], k[2]), FaceOf(k[1], k[0], k[3]), FaceOf(k[2], k[1], k[3]),
              FaceOf(k[0], k[2], k[3])};
    faces_[0].beside = {1, 2, 3};
    faces_[1].beside = {0, 3, 2};
    faces_[2].beside = {0, 1, 3};
    faces_[3].beside = {0, 2, 1};
    for (int point = 0; point < Count(); ++point) Give(point, 0);
  }

  HullFace FaceOf(int a, int b, int c) const {
    HullFace face;
    face.corners = {a, b, c};
    face.origin = Point(a);
    const Eigen::Vector3d p = Point(b) - Point(a);
    const Eigen::Vector3d q = Point(c) - Point(a);
    face.normal = p.cross(q);
    const Eigen::Vector3d m = p.cwiseAbs();
    const Eigen::Vector3d n = q.cwiseAbs();
    face.size = {m.y() * n.z() + m.z() * n.y(), m.z() * n.x() + m.x() * n.z(),
                 m.x() * n.y() + m.y() * n.x()};
    if (tolerance_m_ > 0) face.tolerance = tolerance_m_ * face.normal.norm();
    return face;
  }

  // The point goes to the first face from `first` on that it is above of; others are inside.
  void Give(int point, std::size_t first) {
    CheckWork(10);
    const Eigen::Vector3d place = Point(point);
    for (std::size_t index = first; index < faces_.size(); ++index) {
      HullFace& face = faces_[index];
      // mostly so, and told without the error
      if (tolerance_m_ > 0 && face.normal.dot(place - face.origin) <= face.tolerance) continue;
      const Height height = HeightOver(face, point);
      if (height.value <= face.tolerance) {
        if (height.value < -height.error || !IsExactlyAbove(face, point)) continue;
      } else if (height.value <= height.error &&
                 (tolerance_m_ > 0 || !IsExactlyAbove(face, point))) {
        continue;
      }
      next_above_[static_cast<std::size_t>(point)] = face.first_above;
      face.first_above = point;
      if (face.highest == kNone || height.value > face.most_above) {
        face.highest = point;
        face.most_above = height.value;
      }
      return;
    }
  }

  // Takes away what the highest point over a face sees, and puts a cone in its place.
  void Add(int start) {
    const int apex = Face(start).highest;
    seen_.assign(1, start);
    Face(start).gone = true;
    rim_.clear();
    loose_.clear();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const HullFace& face = Face(seen_[i]);
      for (int point = face.first_above; point != kNone;
           point = next_above_[static_cast<std::size_t>(point)]) {
        if (point != apex) loose_.push_back(point);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        HullFace& next = Face(face.beside[k]);
        if (next.gone) continue;
        if (IsAbove(next, apex)) {
          next.gone = true;
          seen_.push_back(face.beside[k]);
        } else {
          rim_.push_back({face.corners[k], face.corners[(k + 1) % 3], face.beside[k]});
        }
      }
    }
    const std::size_t first = faces_.size();
    AddCone(apex);
    for (const int point : loose_) Give(point, first);
  }

  void AddCone(int apex) {
    const std::size_t first = faces_.size();
    for (const auto& [from, to, stays] : rim_) {
      const int number = static_cast<int>(faces_.size());
      face_from_[static_cast<std::size_t>(from)] = number;
      HullFace& neighbour = Face(stays);
      for (std::size_t k = 0; k < 3; ++k) {
        if (neighbour.corners[k] == to && neighbour.corners[(k + 1) % 3] == from)
          neighbour.beside[k] = number;
      }
      faces_.push_back(FaceOf(from, to, apex));
      faces_.back().beside[0] = stays;
    }
    for (std::size_t i = first; i < faces_.size(); ++i) {
      const int next = face_from_[static_cast<std::size_t>(faces_[i].corners[1])];
      faces_[i].beside[1] = next;
      Face(next).beside[2] = static_cast<int>(i);
    }
  }

  TriangleMesh Mesh() const {
    TriangleMesh mesh;
    std::vector<int> number(points_.size(), kNone);
    for (const HullFace& face : faces_) {
      if (face.gone) continue;
      Eigen::Vector3i triangle;
      for (int k = 0; k < 3; ++k) {
        const int point = face.corners[static_cast<std::size_t>(k)];
        int& at = number[static_cast<std::size_t>(point)];
        if (at == kNone) {
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
  double tolerance_m_;
  std::vector<HullFace> faces_;
  std::vector<int> next_above_;  // by point: the next one above the same face
  std::vector<int> face_from_;   // by point: the new face whose edge of the rim begins there
  std::vector<int> seen_, loose_;
  std::vector<std::array<int, 3>> rim_;  // edge, and the face that stays beside it
};

}  // namespace

std::optional<TriangleMesh> GrownHull(std::span<const Eigen::Vector3d> points, double tolerance_m) {
  return GrowingHull(points, tolerance_m).Grow();
}

}  // namespace doorforge

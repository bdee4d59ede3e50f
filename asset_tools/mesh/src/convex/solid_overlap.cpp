// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/solid_overlap.h"

#include <algorithm>
#include <limits>

#include "doorforge/mesh/work_budget.h"

#include "convex/convex_region.h"
#include "measure/triangle_tree.h"

namespace doorforge {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kOnFace = 1e-4;  // [m] a solid's own surface lies on the faces of its convex parts

// The common part of convex regions.
class Common {
 public:
  explicit Common(std::span<const TriangleMesh> regions) {
    for (const TriangleMesh& region : regions) {
      for (const HalfSpace& face : HalfSpacesOf(region)) faces_.push_back(face);
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& vertex : region.vertices) box.extend(vertex);
      box.min().array() -= kOnFace;
      box.max().array() += kOnFace;
      box_ = boxed_ ? box_.intersection(box) : box;
      boxed_ = true;
    }
  }

  bool Contains(const Eigen::Vector3d& point) const {
    return box_.contains(point) &&
           std::all_of(faces_.begin(), faces_.end(), [&](const HalfSpace& face) {
             return face.normal.dot(point) <= face.offset + kOnFace;
           });
  }

  const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  std::vector<HalfSpace> faces_;
  Eigen::AlignedBox3d box_;
  bool boxed_ = false;
};

}  // namespace

struct SolidOverlap::Surfaces {
  Surfaces(const TriangleMesh& of_moving, const TriangleMesh& of_fixed)
      : moving(of_moving), fixed(of_fixed), moving_tree(of_moving), fixed_tree(of_fixed) {}

  TriangleMesh moving;
  TriangleMesh fixed;
  TriangleTree moving_tree;
  TriangleTree fixed_tree;
};

namespace {

// Points of the placed surface in the common region for which `is_inside` holds.
template <class IsInside>
void AddPoints(const TriangleMesh& mesh, const RigidTransform& placed, const Common& common,
               double step_m, const IsInside& is_inside, Points& points) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d a = placed * mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d b = placed * mesh.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d c = placed * mesh.vertices[static_cast<std::size_t>(t[2])];
    Eigen::AlignedBox3d box(a);
    box.extend(b).extend(c);
    if (!box.intersects(common.box())) continue;
    const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
    const int steps = 1 + static_cast<int>(longest / step_m);
    for (int u = 0; u <= steps; ++u) {
      CheckWork(static_cast<unsigned>(steps - u + 1));
      for (int v = 0; u + v <= steps; ++v) {
        const Eigen::Vector3d point = a + (b - a) * u / steps + (c - a) * v / steps;
        if (common.Contains(point) && is_inside(point)) points.push_back(point);
      }
    }
  }
}

}  // namespace

SolidOverlap::SolidOverlap(const TriangleMesh& moving, const TriangleMesh& fixed)
    : surfaces_(std::make_unique<const Surfaces>(moving, fixed)) {}

SolidOverlap::~SolidOverlap() = default;

std::vector<Eigen::Vector3d> SolidOverlap::CommonSurface(const RigidTransform& fixed_from_moving,
                                                         std::span<const TriangleMesh> regions,
                                                         double step_m) const {
  const Common common(regions);
  const RigidTransform moving_from_fixed = fixed_from_moving.inverse();
  Points points;
  AddPoints(
      surfaces_->moving, fixed_from_moving, common, step_m,
      [&](const Eigen::Vector3d& p) { return surfaces_->fixed_tree.IsInside(p); }, points);
  AddPoints(
      surfaces_->fixed, RigidTransform::Identity(), common, step_m,
      [&](const Eigen::Vector3d& p) {
        return surfaces_->moving_tree.IsInside(moving_from_fixed * p);
      },
      points);
  return points;
}

namespace {

// How far a piece reaches from a point inside it.
double ReachOf(const std::vector<HalfSpace>& piece, const Eigen::Vector3d& point,
               const Eigen::Vector3d& direction) {
  double reach = std::numeric_limits<double>::infinity();
  for (const HalfSpace& face : piece) {
    const double across = face.normal.dot(direction);
    if (across > 1e-9) reach = std::min(reach, (face.offset - face.normal.dot(point)) / across);
  }
  return std::max(0.0, reach);
}

// How far the solid goes on from a point in it or on its surface, no farther than the piece.
double ReachOf(const TriangleTree& solid, const std::vector<HalfSpace>& piece,
               const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d behind = point + kOnFace * direction;
  if (!solid.IsInside(behind)) return 0;
  return std::min(solid.FirstHit(behind, direction, 0) + kOnFace, ReachOf(piece, point, direction));
}

double Extreme(const TriangleMesh& mesh, const Eigen::Vector3d& direction) {
  double extreme = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    extreme = std::max(extreme, direction.dot(vertex));
  return extreme;
}

}  // namespace

double SolidOverlap::DepthAlong(const RigidTransform& fixed_from_moving,
                                std::span<const TriangleMesh, 2> pieces,
                                const Eigen::Vector3d& line,
                                std::span<const Eigen::Vector3d> common) const {
  Eigen::Vector3d up = line.normalized();  // where the moving piece ends
  if (Extreme(pieces[0], -up) + Extreme(pieces[1], up) <
      Extreme(pieces[0], up) + Extreme(pieces[1], -up))
    up = -up;
  const std::vector<HalfSpace> fixed_piece = HalfSpacesOf(pieces[1]);
  const RigidTransform moving_from_fixed = fixed_from_moving.inverse();
  const Eigen::Vector3d moving_up = moving_from_fixed.linear() * up;
  TriangleMesh own_piece = pieces[0];
  for (Eigen::Vector3d& vertex : own_piece.vertices) vertex = moving_from_fixed * vertex;
  const std::vector<HalfSpace> moving_piece = HalfSpacesOf(own_piece);
  double most = 0;
  for (const Eigen::Vector3d& point : common) {
    most = std::max(
        most, ReachOf(surfaces_->moving_tree, moving_piece, moving_from_fixed * point, moving_up) +
                  ReachOf(surfaces_->fixed_tree, fixed_piece, point, -up));
  }
  return most;
}

double LeastExtent(std::span<const Eigen::Vector3d> points, std::span<const Eigen::Vector3d> also) {
  if (points.size() < 2) return 0;
  double least = std::numeric_limits<double>::infinity();
  const auto try_one = [&](const Eigen::Vector3d& direction) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& point : points) {
      low = std::min(low, direction.dot(point));
      high = std::max(high, direction.dot(point));
    }
    least = std::min(least, high - low);
  };
  for (const Eigen::Vector3d& direction : also) try_one(direction.normalized());
  for (int code = 14; code < 27; ++code)  // one of each pair of opposites
    try_one(
        Eigen::Vector3i(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).cast<double>().normalized());
  return least;
}

}  // namespace doorforge

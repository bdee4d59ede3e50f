// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/leaf_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "collision/convex_probe.h"

namespace doorforge {
namespace {

constexpr double kHingeStep = std::numbers::pi / 90;
constexpr int kHandleSteps = 4;

struct Piece {
  internal::ProbeHull hull;
  const TriangleMesh* mesh;
  int link;
  const std::string* name;
};

struct Overlap {
  double depth_m = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

Overlap Lesser(const Overlap& a, const Overlap& b) { return b.depth_m < a.depth_m ? b : a; }

// How far two pieces reach into each other along a direction.
Overlap OverlapAlong(const Eigen::Vector3d& direction, std::span<const Eigen::Vector3d> of,
                     std::span<const Eigen::Vector3d> in) {
  double most = -std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : of) most = std::max(most, direction.dot(point));
  for (const Eigen::Vector3d& point : in) least = std::min(least, direction.dot(point));
  return {most - least, direction};
}

// The least of these along the normals of a piece's faces.
Overlap OverlapAlongFaces(const TriangleMesh& faces, const RigidTransform& placed,
                          std::span<const Eigen::Vector3d> of,
                          std::span<const Eigen::Vector3d> in) {
  Overlap least{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()};
  for (const Eigen::Vector3i& t : faces.triangles) {
    const Eigen::Vector3d& a = faces.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = faces.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = faces.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-12) continue;
    least = Lesser(least, OverlapAlong(placed.linear() * normal.normalized(), of, in));
  }
  return least;
}

// Expanding polytopes stop short of the depth of boxes with faces in one plane, so their answer
// counts as a direction alone: along any direction the overlap is at least the depth.
Overlap OverlapOf(const Piece& moving, const RigidTransform& pose, const Piece& fixed) {
  const internal::Separation found = internal::Separate(moving.hull, pose, fixed.hull);
  if (!(found.distance < 0)) return {};
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& vertex : moving.mesh->vertices) points.push_back(pose * vertex);
  const std::vector<Eigen::Vector3d>& others = fixed.mesh->vertices;
  const Overlap across =
      Lesser(OverlapAlong(found.normal, others, points),
             OverlapAlongFaces(*fixed.mesh, RigidTransform::Identity(), others, points));
  return Lesser(across, OverlapAlongFaces(*moving.mesh, pose, points, others));
}

std::vector<Piece> PiecesOf(const DoorAsset& door, int link) {
  std::vector<Piece> pieces;
  for (const DoorGeometry& geometry : door.links[static_cast<std::size_t>(link)].geometry) {
    for (const TriangleMesh& hull : geometry.hulls) {
      if (!hull.vertices.empty())
        pieces.push_back({internal::MakeProbeHull(hull, RigidTransform::Identity(), 0), &hull, link,
                          &geometry.name});
    }
  }
  return pieces;
}

/// Overlaps of every moving piece with every piece of the frame.
class Sweep {
 public:
  explicit Sweep(const DoorAsset& door) : door_(door), fixed_(PiecesOf(door, kBaseLink)) {
    for (const int link : {kLeafLink, kHandleLink}) {
      for (Piece& piece : PiecesOf(door, link)) moving_.push_back(std::move(piece));
    }
    closed_.resize(moving_.size() * fixed_.size());
    ForEachOverlap(0, 0, [&](std::size_t pair, const Overlap& overlap) {
      closed_[pair] = overlap.depth_m;
      Keep(pair, FoundAt(overlap, 0, 0), closed_worst_);
    });
    opening_.resize(closed_.size());
  }

  void Try(double hinge_rad, double handle_rad) {
    ForEachOverlap(hinge_rad, handle_rad, [&](std::size_t pair, const Overlap& overlap) {
      SweepOverlap found = FoundAt(overlap, hinge_rad, handle_rad);
      found.depth_m -= closed_[pair];
      Keep(pair, std::move(found), opening_[pair]);
    });
  }

  LeafSweep Result() const {
    LeafSweep result{closed_worst_, {}, {}};
    for (const SweepOverlap& found : opening_) {
      if (found.depth_m > 0) result.opening_pairs.push_back(found);
    }
    std::stable_sort(
        result.opening_pairs.begin(), result.opening_pairs.end(),
        [](const SweepOverlap& a, const SweepOverlap& b) { return a.depth_m > b.depth_m; });
    if (!result.opening_pairs.empty()) result.opening = result.opening_pairs.front();
    return result;
  }

 private:
  static SweepOverlap FoundAt(const Overlap& overlap, double hinge_rad, double handle_rad) {
    SweepOverlap found;
    found.depth_m = found.total_m = overlap.depth_m;
    found.direction = overlap.direction;
    found.hinge_rad = hinge_rad;
    found.handle_rad = handle_rad;
    return found;
  }

  void Keep(std::size_t pair, SweepOverlap found, SweepOverlap& worst) const {
    if (found.depth_m <= worst.depth_m) return;
    const Piece& moving = moving_[pair / fixed_.size()];
    const Piece& fixed = fixed_[pair % fixed_.size()];
    found.moving = *moving.name;
    found.fixed = *fixed.name;
    found.moving_hull = moving.mesh;
    found.fixed_hull = fixed.mesh;
    worst = std::move(found);
  }

  template <class Visit>
  void ForEachOverlap(double hinge_rad, double handle_rad, const Visit& visit) const {
    const auto poses = DoorFromLinks(door_, hinge_rad, handle_rad);
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const RigidTransform& pose = poses[static_cast<std::size_t>(moving_[i].link)];
      const Eigen::AlignedBox3d box = moving_[i].hull.box.transformed(pose);
      for (std::size_t k = 0; k < fixed_.size(); ++k) {
        if (!box.intersects(fixed_[k].hull.box)) continue;
        const Overlap overlap = OverlapOf(moving_[i], pose, fixed_[k]);
        if (overlap.depth_m > 0) visit(i * fixed_.size() + k, overlap);
      }
    }
  }

  const DoorAsset& door_;
  std::vector<Piece> fixed_;
  std::vector<Piece> moving_;
  std::vector<double> closed_;         // depth by pair: moving * fixed count + fixed
  std::vector<SweepOverlap> opening_;  // the same
  SweepOverlap closed_worst_;
};

}  // namespace

LeafSweep SweepLeaf(const DoorAsset& door) {
  Sweep sweep(door);
  const double turned = door.handle_joint.upper_rad;
  for (int i = 1; i <= kHandleSteps && turned > 0; ++i) sweep.Try(0, turned * i / kHandleSteps);
  const int steps = static_cast<int>(std::ceil(door.hinge.upper_rad / kHingeStep));
  for (int i = 1; i <= steps; ++i) {
    const double hinge_rad = door.hinge.upper_rad * i / steps;
    sweep.Try(hinge_rad, 0);
    if (turned > 0) sweep.Try(hinge_rad, turned);
  }
  return sweep.Result();
}

}  // namespace doorforge

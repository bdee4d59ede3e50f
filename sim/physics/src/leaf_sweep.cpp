// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/leaf_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "convex_probe.h"

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

// How far two pieces reach into each other along a direction.
double OverlapAlong(const Eigen::Vector3d& direction, std::span<const Eigen::Vector3d> of,
                    std::span<const Eigen::Vector3d> in) {
  double most = -std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : of) most = std::max(most, direction.dot(point));
  for (const Eigen::Vector3d& point : in) least = std::min(least, direction.dot(point));
  return most - least;
}

// The least of these along the normals of a piece's faces.
double OverlapAlongFaces(const TriangleMesh& faces, const RigidTransform& placed,
                         std::span<const Eigen::Vector3d> of, std::span<const Eigen::Vector3d> in) {
  double depth = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : faces.triangles) {
    const Eigen::Vector3d& a = faces.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = faces.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = faces.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-12) continue;
    depth = std::min(depth, OverlapAlong(placed.linear() * normal.normalized(), of, in));
  }
  return depth;
}

// Expanding polytopes stop short of the depth of boxes with faces in one plane, so their answer
// counts as a direction alone: along any direction the overlap is at least the depth.
double DepthOf(const Piece& moving, const RigidTransform& pose, const Piece& fixed) {
  const internal::Separation found = internal::Separate(moving.hull, pose, fixed.hull);
  if (!(found.distance < 0)) return 0;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& vertex : moving.mesh->vertices) points.push_back(pose * vertex);
  const std::vector<Eigen::Vector3d>& others = fixed.mesh->vertices;
  return std::min({OverlapAlong(found.normal, others, points),
                   OverlapAlongFaces(*fixed.mesh, RigidTransform::Identity(), others, points),
                   OverlapAlongFaces(*moving.mesh, pose, points, others)});
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
    closed_depth_.assign(moving_.size() * fixed_.size(), 0);
    ForEachOverlap(0, 0, [&](std::size_t pair, double depth) { closed_depth_[pair] = depth; });
  }

  SweepOverlap Closed() const {
    SweepOverlap worst;
    for (std::size_t pair = 0; pair < closed_depth_.size(); ++pair)
      Keep(pair, {closed_depth_[pair], 0, 0, {}, {}}, worst);
    return worst;
  }

  void Try(double hinge_rad, double handle_rad, SweepOverlap& worst) const {
    ForEachOverlap(hinge_rad, handle_rad, [&](std::size_t pair, double depth) {
      Keep(pair, {depth - closed_depth_[pair], hinge_rad, handle_rad, {}, {}}, worst);
    });
  }

 private:
  void Keep(std::size_t pair, SweepOverlap found, SweepOverlap& worst) const {
    if (found.depth_m <= worst.depth_m) return;
    found.moving = *moving_[pair / fixed_.size()].name;
    found.fixed = *fixed_[pair % fixed_.size()].name;
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
        const double depth = DepthOf(moving_[i], pose, fixed_[k]);
        if (depth > 0) visit(i * fixed_.size() + k, depth);
      }
    }
  }

  const DoorAsset& door_;
  std::vector<Piece> fixed_;
  std::vector<Piece> moving_;
  std::vector<double> closed_depth_;  // by pair: moving * fixed count + fixed
};

}  // namespace

LeafSweep SweepLeaf(const DoorAsset& door) {
  const Sweep sweep(door);
  LeafSweep result{sweep.Closed(), {}};
  const double turned = door.handle_joint.upper_rad;
  for (int i = 1; i <= kHandleSteps && turned > 0; ++i)
    sweep.Try(0, turned * i / kHandleSteps, result.opening);
  const int steps = static_cast<int>(std::ceil(door.hinge.upper_rad / kHingeStep));
  for (int i = 1; i <= steps; ++i) {
    const double hinge_rad = door.hinge.upper_rad * i / steps;
    sweep.Try(hinge_rad, 0, result.opening);
    if (turned > 0) sweep.Try(hinge_rad, turned, result.opening);
  }
  return result;
}

}  // namespace doorforge

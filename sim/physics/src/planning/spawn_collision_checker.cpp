// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/spawn_collision_checker.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "collision/convex_probe.h"

namespace doorforge {
namespace {

constexpr double kStartMargin = 0.001;

struct ProbedPiece {
  internal::ProbeHull hull;
  int body;  // the robot's joint, or the door's link
  std::string name;
};

ProbedPiece MakePiece(const TriangleMesh& mesh, int body, const std::string& name) {
  return {internal::MakeProbeHull(mesh, RigidTransform::Identity(), kStartMargin), body, name};
}

bool DoOverlap(const ProbedPiece& a, const RigidTransform& b_from_a, const ProbedPiece& b) {
  if (!a.hull.box.transformed(b_from_a).intersects(b.hull.box)) return false;
  const double distance = internal::Separate(a.hull, b_from_a, b.hull).distance;
  // no distance is found only for pieces that share so much that no way out is
  return distance < 0 || !std::isfinite(distance);
}

}  // namespace

class SpawnCollisionChecker::Runtime {
 public:
  std::vector<ProbedPiece> robot;
  std::vector<ProbedPiece> door;
  std::array<RigidTransform, 3> door_from_link;
};

SpawnCollisionChecker::SpawnCollisionChecker(const DoorAsset& door, const RobotModel& robot,
                                             double hinge_rad, double handle_rad)
    : runtime_(std::make_unique<Runtime>()) {
  runtime_->door_from_link = DoorFromLinks(door, hinge_rad, handle_rad);
  for (const RobotPiece& piece : robot.hulls())
    runtime_->robot.push_back(MakePiece(piece.mesh, piece.joint, piece.name));
  for (const int link : {kBaseLink, kLeafLink, kHandleLink}) {
    for (const DoorGeometry& geometry : door.links[static_cast<std::size_t>(link)].geometry) {
      for (const TriangleMesh& hull : geometry.hulls)
        runtime_->door.push_back(MakePiece(hull, link, geometry.name));
    }
  }
}

SpawnCollisionChecker::~SpawnCollisionChecker() = default;
SpawnCollisionChecker::SpawnCollisionChecker(SpawnCollisionChecker&&) noexcept = default;
SpawnCollisionChecker& SpawnCollisionChecker::operator=(SpawnCollisionChecker&&) noexcept = default;

std::optional<StartOverlap> SpawnCollisionChecker::Find(
    const RobotPose& pose, const RigidTransform& world_from_door) const {
  for (const ProbedPiece& part : runtime_->door) {
    const RigidTransform part_from_world =
        (world_from_door * runtime_->door_from_link[static_cast<std::size_t>(part.body)]).inverse();
    for (const ProbedPiece& piece : runtime_->robot) {
      const RigidTransform& world_from_piece =
          piece.body < 0 ? pose.world_from_base
                         : pose.world_from_body[static_cast<std::size_t>(piece.body)];
      if (DoOverlap(piece, part_from_world * world_from_piece, part))
        return StartOverlap{piece.name, part.name};
    }
  }
  return std::nullopt;
}

double SpawnCollisionChecker::Crowding(const RobotPose& pose, const RigidTransform& world_from_door,
                                       double gap_m) const {
  const RigidTransform door_from_world = world_from_door.inverse();
  double sum = 0;
  for (const ProbedPiece& piece : runtime_->robot) {
    const RigidTransform& world_from_piece =
        piece.body < 0 ? pose.world_from_base
                       : pose.world_from_body[static_cast<std::size_t>(piece.body)];
    const RigidTransform door_from_piece = door_from_world * world_from_piece;
    double clearance = gap_m;
    for (const ProbedPiece& part : runtime_->door) {
      if (part.body == kHandleLink) continue;
      const RigidTransform part_from_piece =
          runtime_->door_from_link[static_cast<std::size_t>(part.body)].inverse() * door_from_piece;
      if (piece.hull.box.transformed(part_from_piece).exteriorDistance(part.hull.box) >= clearance)
        continue;
      const double distance = internal::Separate(piece.hull, part_from_piece, part.hull).distance;
      clearance = std::min(clearance, std::isfinite(distance) ? distance : -0.02);
    }
    sum += std::min(gap_m - clearance, 0.02);
  }
  return sum;
}

}  // namespace doorforge

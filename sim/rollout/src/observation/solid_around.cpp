// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/solid_around.h"

#include <algorithm>

namespace doorforge {
namespace {

constexpr std::string_view kDoorSolids[] = {"frame", "leaf", "handle"};  // by DoorLinkIndex

bool IsInsideHull(const TriangleMesh& hull, const Eigen::Vector3d& point) {
  return !hull.triangles.empty() &&
         std::all_of(hull.triangles.begin(), hull.triangles.end(), [&](const auto& triangle) {
           const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(triangle[0])];
           const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(triangle[1])];
           const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(triangle[2])];
           return (b - a).cross(c - a).dot(point - a) < 0;
         });
}

bool IsInsideLink(const DoorLink& link, const Eigen::Vector3d& point) {
  return std::any_of(link.geometry.begin(), link.geometry.end(), [&](const DoorGeometry& geometry) {
    return std::any_of(geometry.hulls.begin(), geometry.hulls.end(),
                       [&](const TriangleMesh& hull) { return IsInsideHull(hull, point); });
  });
}

}  // namespace

std::string_view SolidAround(const Eigen::Vector3d& point_m, const Scene& scene,
                             const DoorAsset& door) {
  const auto door_from_link = DoorFromLinks(door, 0, 0);
  for (std::size_t link = 0; link < door.links.size(); ++link) {
    const RigidTransform world_from_link = scene.world_from_door * door_from_link.at(link);
    if (IsInsideLink(door.links[link], world_from_link.inverse() * point_m))
      return kDoorSolids[link];
  }
  return {};
}

std::string_view SolidAround(const Eigen::Vector3d& point_m, const RobotModel& robot,
                             const RobotPose& pose) {
  for (const RobotPiece& piece : robot.hulls()) {
    const RigidTransform& world_from_piece =
        piece.joint < 0 ? pose.world_from_base
                        : pose.world_from_body[static_cast<std::size_t>(piece.joint)];
    if (IsInsideHull(piece.mesh, world_from_piece.inverse() * point_m)) return piece.name;
  }
  return {};
}

}  // namespace doorforge

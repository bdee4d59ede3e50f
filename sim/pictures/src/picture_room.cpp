// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "picture_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace doorforge {
namespace {

constexpr float kLeastHeight = 2.6F;  // [m] of the room
constexpr float kHeadroom = 0.25F;    // over the door
constexpr float kSideways = 1.6F;     // beside the door
constexpr float kBefore = 3.2F;       // in front of it
constexpr float kBehind = 2.6F;       // of the room behind
constexpr float kWallGap = 0.03F;     // behind what stands before a wall
constexpr float kWallThickness = 0.1F;
constexpr float kElbowRoom = 0.4F;  // around cameras
constexpr float kGap = 0.01F;       // what is smaller needs no plinth
constexpr float kNear = 1e-4F;

// It bounds a link of the closed door.
Eigen::AlignedBox3f BoxOf(const Scene& scene, const DoorAsset& door, std::size_t link) {
  const RigidTransform world_from_link = scene.world_from_door * DoorFromLinks(door, 0, 0).at(link);
  Eigen::AlignedBox3f box;
  for (const DoorGeometry& geometry : door.links[link].geometry) {
    for (const Eigen::Vector3d& vertex : geometry.mesh.vertices)
      box.extend((world_from_link * vertex).cast<float>());
  }
  return box;
}

// A link may have no shape.
Eigen::AlignedBox3f BoxOfDoor(const Scene& scene, const DoorAsset& door) {
  Eigen::AlignedBox3f box = BoxOf(scene, door, kBaseLink);
  box.extend(BoxOf(scene, door, kLeafLink));
  return box.extend(BoxOf(scene, door, kHandleLink));
}

Eigen::AlignedBox3f BoxOfFrame(const Scene& scene, const DoorAsset& door) {
  const Eigen::AlignedBox3f frame = BoxOf(scene, door, kBaseLink);
  return frame.isEmpty() ? BoxOf(scene, door, kLeafLink) : frame;
}

// Points in y and z.
std::vector<Eigen::Vector2f> OutlineOf(const Scene& scene, const DoorAsset& door,
                                       std::size_t link) {
  const RigidTransform world_from_link = scene.world_from_door * DoorFromLinks(door, 0, 0).at(link);
  std::vector<Eigen::Vector2f> points;
  for (const DoorGeometry& geometry : door.links[link].geometry) {
    for (const Eigen::Vector3d& vertex : geometry.mesh.vertices)
      points.push_back((world_from_link * vertex).cast<float>().tail<2>());
  }
  return points;
}

std::vector<Eigen::Vector2f> OutlineOfFrame(const Scene& scene, const DoorAsset& door) {
  const std::vector<Eigen::Vector2f> frame = OutlineOf(scene, door, kBaseLink);
  return frame.empty() ? OutlineOf(scene, door, kLeafLink) : frame;
}

float Area(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Corners against the clock, by Andrew's monotone chain (1979).
std::vector<Eigen::Vector2f> ConvexOutline(std::vector<Eigen::Vector2f> points) {
  std::ranges::sort(points, [](const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Eigen::Vector2f> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Eigen::Vector2f& point : points) {
      while (hull.size() >= begin + 2 && Area(hull[hull.size() - 2], hull.back(), point) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

// Where the robot stands; nowhere if it flies.
std::optional<float> RobotsFloor(const PictureScene& scene) {
  std::optional<float> lowest;
  for (const RobotPiece& piece : scene.robot.visuals()) {
    if (piece.joint >= 0) continue;
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices) {
      const auto z = static_cast<float>((scene.scene.world_from_robot_base * vertex).z());
      lowest = std::min(z, lowest.value_or(z));
    }
  }
  return lowest;
}

}  // namespace

WallHole::WallHole(const std::vector<Eigen::Vector2f>& outline) {
  for (const Eigen::Vector2f& point : outline) box_.extend(point);
  const std::vector<Eigen::Vector2f> hull = ConvexOutline(outline);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    constexpr float kStraight = 1e-4F;  // [m] the box says all of a side along an axis
    const Eigen::Vector2f side = hull[(i + 1) % hull.size()] - hull[i];
    if (side.cwiseAbs().minCoeff() < kStraight) continue;
    const Eigen::Vector2f outward(side.y(), -side.x());
    slopes_.emplace_back(outward.x(), outward.y(), outward.dot(hull[i]));
  }
}

bool WallHole::contains(const Eigen::Vector2f& point) const {
  return box_.contains(point) && std::ranges::all_of(slopes_, [&](const Eigen::Vector3f& slope) {
           return slope.head<2>().dot(point) <= slope.z();
         });
}

bool DoorWall::Holds(const Eigen::Vector3f& point) const {
  return hole && std::fabs(point.x() - x) < kWallThickness / 2 && !hole->contains(point.tail<2>());
}

DoorWall DoorWallOf(const Scene& scene, const DoorAsset& door) {
  if (door.category != Category::kInterior && door.category != Category::kWindow)
    return {BoxOfDoor(scene, door).min().x() - kWallGap, {}};
  return {BoxOfFrame(scene, door).center().x(), WallHole(OutlineOfFrame(scene, door))};
}

PictureRoom::PictureRoom(const PictureScene& scene, const PicturesConfig& config)
    : wall_(DoorWallOf(scene.scene, scene.door)) {
  const Eigen::AlignedBox3f frame = BoxOfFrame(scene.scene, scene.door);
  const Eigen::AlignedBox3f door = BoxOfDoor(scene.scene, scene.door);
  const bool in_wall = wall_.hole.has_value();
  const float floor = std::min(RobotsFloor(scene).value_or(0.0F), door.min().z());
  if (!in_wall && door.min().z() > floor + kGap) {
    plinth_ = door;
    plinth_->min().z() = floor;
    plinth_->max() = Eigen::Vector3f(frame.max().x(), frame.max().y(), door.min().z());
  }
  box_ = door;
  box_.extend(Eigen::Vector3f(door.max().x() + kBefore, door.max().y() + kSideways,
                              std::max(floor + kLeastHeight, door.max().z() + kHeadroom)));
  box_.extend(
      Eigen::Vector3f(in_wall ? wall_.x - kBehind : wall_.x, door.min().y() - kSideways, floor));
  const auto hold = [&](const CameraModel& camera) {
    const Eigen::Vector3f eye = camera.position_m.cast<float>();
    const Eigen::Vector3f room = Eigen::Vector3f::Constant(kElbowRoom);
    box_.extend(Eigen::AlignedBox3f(eye - room, eye + room));
  };
  hold(scene.scene.camera);
  for (const PictureCamera& camera : config.cameras) {
    if (camera.at == CameraPlace::kWorld) hold(CameraOf(camera, scene.scene));
  }
  // only who looks from behind sees that there is a wall of a thing that stands before one
  if (!in_wall && box_.min().x() >= wall_.x - kElbowRoom) box_.min().x() = wall_.x;
}

RoomHit PictureRoom::Meet(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  RoomHit hit;
  hit.distance = std::numeric_limits<float>::infinity();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const float along = direction[axis];
    if (along == 0) continue;
    const float distance = ((along > 0 ? box_.max() : box_.min())[axis] - origin[axis]) / along;
    if (!(distance > kNear) || distance >= hit.distance) continue;
    hit.distance = distance;
    hit.normal = Eigen::Vector3f::Unit(axis) * (along > 0 ? -1.0F : 1.0F);
    hit.part = axis < 2 ? RoomPart::kWalls : (along > 0 ? RoomPart::kCeiling : RoomPart::kFloor);
    if (axis == 0 && along < 0 && !wall_.hole) hit.part = RoomPart::kDoorWall;
  }
  if (const auto wall = MeetDoorWall(origin, direction); wall && *wall < hit.distance)
    hit = {*wall, RoomPart::kDoorWall,
           Eigen::Vector3f(direction.x() > 0 ? -1.0F : 1.0F, 0.0F, 0.0F)};
  if (const auto plinth = MeetPlinth(origin, direction); plinth && plinth->distance < hit.distance)
    hit = *plinth;
  return hit;
}

bool PictureRoom::Blocks(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                         float reach) const {
  const float to_wall = wall_.x - origin.x();
  const bool crosses =
      to_wall * direction.x() > 0 && std::fabs(to_wall) < std::fabs(direction.x()) * reach;
  if (crosses && MeetDoorWall(origin, direction)) return true;
  if (!plinth_) return false;
  const auto plinth = MeetPlinth(origin, direction);
  return plinth && plinth->distance < reach;
}

bool PictureRoom::IsWithin(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                           float reach) const {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const float along = direction[axis] * reach;
    const float end = origin[axis] + along;
    if (along > 0 ? end > box_.max()[axis] : end < box_.min()[axis]) return true;
  }
  return Blocks(origin, direction, reach);
}

std::optional<float> PictureRoom::MeetDoorWall(const Eigen::Vector3f& origin,
                                               const Eigen::Vector3f& direction) const {
  if (!wall_.hole || direction.x() == 0) return {};
  const float distance = (wall_.x - origin.x()) / direction.x();
  if (!(distance > kNear)) return {};
  const Eigen::Vector2f at = (origin + distance * direction).tail<2>();
  if (wall_.hole->contains(at)) return {};
  return distance;
}

std::optional<RoomHit> PictureRoom::MeetPlinth(const Eigen::Vector3f& origin,
                                               const Eigen::Vector3f& direction) const {
  if (!plinth_) return {};
  float enter = 0;
  float leave = std::numeric_limits<float>::infinity();
  Eigen::Index side = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < plinth_->min()[axis] || origin[axis] > plinth_->max()[axis]) return {};
      continue;
    }
    float first = (plinth_->min()[axis] - origin[axis]) / direction[axis];
    float second = (plinth_->max()[axis] - origin[axis]) / direction[axis];
    if (first > second) std::swap(first, second);
    if (first > enter) side = axis;
    enter = std::max(enter, first);
    leave = std::min(leave, second);
  }
  if (!(enter > kNear) || enter >= leave) return {};
  return RoomHit{enter, RoomPart::kPlinth,
                 Eigen::Vector3f::Unit(side) * (direction[side] > 0 ? -1.0F : 1.0F)};
}

}  // namespace doorforge

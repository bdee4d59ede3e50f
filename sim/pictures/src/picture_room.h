// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/pictures/take_pictures.h"

namespace doorforge {

/// The parts of the room around a door.
enum class RoomPart : std::uint8_t { kFloor, kCeiling, kWalls, kDoorWall, kPlinth };
inline constexpr std::size_t kRoomPartCount = 5;

/// Where a ray meets the room.
struct RoomHit {
  float distance = 0;  ///< In lengths of the direction.
  RoomPart part = RoomPart::kWalls;
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< Towards the ray's origin.
};

/// What is cut out of a wall, in y and z: the convex outline of a frame.
class WallHole {
 public:
  /// `outline` holds the points that it is to enclose, three at least that span an area.
  explicit WallHole(const std::vector<Eigen::Vector2f>& outline);

  bool contains(const Eigen::Vector2f& point) const;

 private:
  Eigen::AlignedBox2f box_;
  std::vector<Eigen::Vector3f> slopes_;  // (a, b, c): a y + b z <= c; of sides along no axis
};

/// The wall that a door is in, or stands before.
struct DoorWall {
  float x = 0;                   ///< Where it is, in the world.
  std::optional<WallHole> hole;  ///< For what is in it.

  /// Whether a point is in the thickness of a wall with a hole.
  bool Holds(const Eigen::Vector3f& point) const;
};
DoorWall DoorWallOf(const Scene& scene, const DoorAsset& door);

/// A room around a door, which only pictures show: a box in the world. Doors and windows stand in a
/// wall with a hole of their size and another room behind it; everything else stands before the
/// wall, on a plinth where it does not reach the floor. Rays begin inside.
class PictureRoom {
 public:
  /// The room holds the door, the robot, and the cameras that stand in the world.
  PictureRoom(const PictureScene& scene, const PicturesConfig& config);

  RoomHit Meet(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  /// Whether the wall of the door or the plinth is on the way, up to `reach` directions.
  bool Blocks(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach) const;
  /// Whether any of it, its box included, is on the way.
  bool IsWithin(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach) const;
  bool IsBehindWall(const Eigen::Vector3f& point) const {
    return wall_.hole && point.x() < wall_.x;
  }

  const Eigen::AlignedBox3f& box() const { return box_; }
  float wall_x() const { return wall_.x; }

 private:
  std::optional<float> MeetDoorWall(const Eigen::Vector3f& origin,
                                    const Eigen::Vector3f& direction) const;
  std::optional<RoomHit> MeetPlinth(const Eigen::Vector3f& origin,
                                    const Eigen::Vector3f& direction) const;

  Eigen::AlignedBox3f box_;
  DoorWall wall_;
  std::optional<Eigen::AlignedBox3f> plinth_;
};

}  // namespace doorforge

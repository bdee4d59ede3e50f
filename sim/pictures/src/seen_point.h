// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "doorforge/sensor/scene_geometry.h"

#include "appearance.h"
#include "picture_room.h"

namespace doorforge {

/// What a ray of the camera meets.
struct SeenPoint {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  ///< Smooth, towards the camera.
  Eigen::Vector3f face;    ///< Of the triangle, likewise.
  Eigen::Vector3f view;    ///< Unit, towards the camera.
  std::uint16_t part = 0;  ///< Index of its material.
};

/// Whether two points, neighbours in a picture, lie on one surface without a crease between them.
bool LooksTheSame(const SeenPoint& a, const SeenPoint& b);

/// Rays begin so far off a surface [m].
inline constexpr float kSkin = 5e-4F;
/// Cosine between normals of neighbours that share what they find of light.
inline constexpr float kSameNormal = 0.9F;
/// They are no farther from each other's plane [m].
inline constexpr float kSamePlane = 0.03F;

inline constexpr int kPixelGroup = 8;  ///< Pixels a side that look for light together.

/// Points of the pixels of a picture, row by row.
struct PointImage {
  int width = 0;
  int height = 0;
  std::vector<SeenPoint> points;
  /// Bit 0: the pixel to the right sees another surface; bit 1: the pixel below does.
  std::vector<std::uint8_t> seams;
  /// By group of kPixelGroup x kPixelGroup pixels, row by row: whether their colours are asked for;
  /// empty: all are.
  std::vector<std::uint8_t> wanted;

  std::size_t At(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
  int groups_across() const { return (width + kPixelGroup - 1) / kPixelGroup; }
  bool IsWanted(int column, int row) const {
    return wanted.empty() || wanted[static_cast<std::size_t>(row / kPixelGroup * groups_across() +
                                                             column / kPixelGroup)] != 0;
  }
  /// From now on those groups alone are asked for that have a pixel for which `is_seen` is not 0,
  /// and the eight around each: light, edges and blur reach no farther.
  void WantAround(std::span<const std::uint8_t> is_seen);
  /// Finds the seams between the points.
  void FindSeams();
  /// Whether one of the four neighbours sees another surface.
  bool IsEdge(int column, int row) const;
};

/// Everything that keeps light from a point, and where light comes from.
struct LitScene {
  SceneGeometry& geometry;
  const PictureRoom& room;
  const Appearance& appearance;

  std::span<const Lamp> LampsAt(const SeenPoint& point) const {
    // rounding must not put a point of the wall behind it
    if (room.IsBehindWall(point.position + kSkin * point.face)) return {&appearance.lamp_behind, 1};
    return appearance.lamps;
  }
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/pictures/take_pictures.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/scene_geometry.h"

#include "appearance.h"
#include "picture_room.h"

namespace doorforge {

class PixelDirections;

/// Colours what a camera sees: lamps with soft shadows, light from all around that corners keep
/// out, highlights, mirrors, glass, and the camera's own faults.
///
/// Lamps and surroundings are sampled as Keller and Heidrich (Interleaved Sampling, 2001) do: of 16
/// places of a lamp, neighbouring pixels look for different ones, and what they find is shared by
/// those of a block of 4 x 4 that see the same surface. Pixels whose neighbours see something else
/// are what `samples` rays meet; others would meet the same with each.
class RgbRenderer {
 public:
  /// `geometry` is rendered from whenever Render() is called, its links where they were last put.
  RgbRenderer(const PictureScene& scene, const PicturesConfig& config, SceneGeometry& geometry);

  /// sRGB, height x width x 3.
  ///
  /// @param surfaces What the camera sees, with the links where they are now.
  /// @param look Number of the look: its noise is named by it.
  std::vector<std::uint8_t> Render(const CameraModel& camera, const SurfaceImage& surfaces,
                                   std::size_t look);

 private:
  // What a ray meets.
  struct Point {
    Eigen::Vector3f position;
    Eigen::Vector3f normal;  // smooth, towards the camera
    Eigen::Vector3f face;    // of the triangle, likewise
    Eigen::Vector3f view;    // unit, towards the camera
    std::uint16_t part = 0;  // mesh, pane of a mesh, or part of the room
  };
  // Shares of light in sixteenths, of the lamps and of the surroundings.
  using Shares = std::array<std::uint16_t, kMostLamps + 1>;

  Point MeshPoint(std::size_t mesh, std::size_t triangle, const Eigen::Vector2f& uv,
                  const Eigen::Vector3f& position) const;
  Point RoomPoint(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  bool IsPane(std::size_t mesh, const Eigen::Vector3f& in_mesh) const;
  const Finish& FinishOf(std::uint16_t part) const;
  LinearColor AlbedoOf(const Point& point, const Finish& finish) const;
  std::span<const Lamp> LampsAt(const Point& point) const;

  void FindPoints(const CameraModel& camera, const SurfaceImage& surfaces);
  void SampleLight();
  void SampleTile(int left, int top, int round);
  Shares SharedLight(int column, int row) const;
  LinearColor Shade(const Point& point, const Shares& shares) const;
  LinearColor RoomLight(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  LinearColor Behind(const Point& pane) const;
  void ShadePixels();
  void SmoothEdges(const CameraModel& camera);
  bool IsEdge(int column, int row) const;
  LinearColor EdgeColor(const PixelDirections& directions, int column, int row) const;
  const LinearColor* ColorNear(const Point& point, int column, int row) const;
  void Blur();
  std::vector<std::uint8_t> Develop(std::size_t look) const;

  std::size_t At(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }

  SceneGeometry& geometry_;
  PictureRoom room_;
  Appearance appearance_;
  std::vector<Eigen::AlignedBox3f> pane_boxes_;  // by mesh; empty where there is no pane
  int samples_;
  int rounds_;  // each pixel looks once a round for a place of each lamp
  std::uint32_t seed_;

  int width_ = 0;
  int height_ = 0;
  std::vector<Point> points_;
  std::vector<Shares> light_;
  std::vector<LinearColor> colors_;
};

}  // namespace doorforge

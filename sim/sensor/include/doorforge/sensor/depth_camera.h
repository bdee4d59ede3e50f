// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {

/// What each pixel of a camera sees; all arrays are height x width, row by row from the top left.
struct DepthImage {
  int width = 0;
  int height = 0;
  /// Distance along the optical axis (not along the ray) [m]; infinity where nothing is seen.
  std::vector<float> depth_m;
  std::vector<std::int16_t> link = {};   ///< Link index, -1 where nothing is seen.
  std::vector<std::uint8_t> label = {};  ///< PointLabel values; kOther where nothing is seen.
  /// Colours, sRGB, height x width x 3; empty: none were looked at.
  std::vector<std::uint8_t> rgb{};
};

/// A depth image, and what lies under its pixels; all arrays are height x width likewise.
struct SurfaceImage {
  DepthImage depth;
  std::vector<std::int16_t> mesh;  ///< Index into the scene's meshes, -1 where nothing is seen.
  std::vector<std::uint32_t> triangle;  ///< Index into its triangles.
  std::vector<float> u;  ///< Barycentric coordinates of the triangle's second corner,
  std::vector<float> v;  ///< and of its third.
  /// Unit normal of the triangle in the world, towards the camera; zero where nothing is seen, or a
  /// triangle has no area.
  std::vector<Eigen::Vector3f> normal;
};

/// An ideal depth camera: one ray through the centre of each pixel, no noise, no near limit.
///
/// Embree finds the triangle, in packets of 16 rays over 4 x 4 pixels. The depth itself is
/// computed here in double from the triangle's plane with a fixed order of operations, so that it
/// depends neither on the vector width nor on the reciprocal approximations of the processor.
class DepthCamera {
 public:
  /// @throws Error as SceneGeometry's constructor.
  explicit DepthCamera(std::vector<VisibleMesh> meshes, RayIsa isa = DefaultRayIsa());
  ~DepthCamera();
  DepthCamera(DepthCamera&&) noexcept;
  DepthCamera& operator=(DepthCamera&&) noexcept;

  /// Image of the scene with its links at `world_from_link`. The directions of the rays are kept
  /// until the camera model changes. Same scene, poses and instruction set: same bytes.
  ///
  /// @throws Error(kInvalidArgument) as SceneGeometry::MoveLinks(), or if the camera model's image
  ///     is empty or larger than 8192 pixels a side, or has no pose (such as where it
  ///     looks along `up`).
  DepthImage Render(const CameraModel& camera, std::span<const RigidTransform> world_from_link);

  /// Renders likewise; `depth` has the bytes that Render() gives.
  SurfaceImage RenderSurfaces(const CameraModel& camera,
                              std::span<const RigidTransform> world_from_link);

  /// The scene as it was last rendered, for pictures.
  SceneGeometry& scene() { return scene_; }

 private:
  struct RayTable;

  void Prepare(const CameraModel& camera);

  SceneGeometry scene_;
  std::unique_ptr<RayTable> rays_;
};

}  // namespace doorforge

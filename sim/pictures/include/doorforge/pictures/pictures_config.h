// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/picture_streams.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/sensor/depth_noise.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// What carries a camera.
enum class CameraPlace {
  kScene,  ///< It is the policies' camera itself: its image, its noise, its calibration.
  kWorld,  ///< It stands still, in the world.
  kHand,   ///< It rides on the robot's hand, see RobotPose::world_from_hand.
};
inline constexpr NamedValue<CameraPlace> kCameraPlaces[] = {
    {CameraPlace::kScene, "scene"}, {CameraPlace::kWorld, "world"}, {CameraPlace::kHand, "hand"}};
constexpr std::span<const NamedValue<CameraPlace>> ValuesOf(CameraPlace) { return kCameraPlaces; }

/// A camera that records. Of the scene's own, name and place are all there is to say.
struct PictureCamera {
  std::string name;  ///< In the names of the members: letters, digits and '_'.
  CameraPlace at = CameraPlace::kWorld;
  /// Position, the point in the middle of the image, and what is up in it [m], in the world or in
  /// the hand's frame; empty: DefaultCamera()'s.
  std::vector<double> position_m;
  std::vector<double> target_m;
  std::vector<double> up;
  int width = 256;  ///< 1 to kMostPicturePixels.
  int height = 256;
  double horizontal_fov_rad = 1.2;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("name", self.name);
    visit("at", self.at);
    visit("position_m", self.position_m);
    visit("target_m", self.target_m);
    visit("up", self.up);
    visit("width", self.width);
    visit("height", self.height);
    visit("horizontal_fov_rad", self.horizontal_fov_rad);
  }
};
/// What rays are cast with.
enum class PictureInstructions {
  kUsual,   ///< With what clouds are made with, DefaultRayIsa(): the same bytes on every machine.
  kAvx512,  ///< A fifth faster. A ray in tens of millions meets the other of two triangles at
            ///< their common edge, so some pictures differ from the usual ones in a few pixels.
};
inline constexpr NamedValue<PictureInstructions> kPictureInstructions[] = {
    {PictureInstructions::kUsual, "usual"}, {PictureInstructions::kAvx512, "avx512"}};
constexpr std::span<const NamedValue<PictureInstructions>> ValuesOf(PictureInstructions) {
  return kPictureInstructions;
}

inline constexpr int kMostPicturePixels = 4096;  ///< A side.
inline constexpr int kMostPictureCameras = 16;

/// Pictures at every decision. Without cameras and cloud_rgb there are none, which is the default.
struct PicturesConfig {
  std::vector<PictureCamera> cameras;
  std::vector<PictureStream> streams = {PictureStream::kRgb, PictureStream::kDepth,
                                        PictureStream::kLabel};
  int samples = 16;  ///< Rays of a pixel that colours are made of, 1 to 256.
  /// What is wrong with the depth of all cameras but the scene's, which has the cloud's noise.
  DepthNoiseConfig noise;
  /// The points of clouds have the colours that the policies' camera sees there.
  bool cloud_rgb = false;
  PictureInstructions instructions = PictureInstructions::kUsual;

  bool IsOn() const { return !cameras.empty() || cloud_rgb; }

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("cameras", self.cameras);
    visit("streams", self.streams);
    visit("samples", self.samples);
    visit("noise", self.noise);
    // configurations from before there was a choice stay as they are, byte by byte
    if (!std::is_const_v<Self> || self.cloud_rgb) visit("cloud_rgb", self.cloud_rgb);
    if (!std::is_const_v<Self> || self.instructions != PictureInstructions::kUsual)
      visit("instructions", self.instructions);
  }
};

/// Throws Error(kInvalidConfig), naming the setting, what was found and what is allowed, on a name
/// that is empty, given twice or has other characters, a size or a field of view out of range, a
/// view without a direction, a stream given twice or none at all, too many cameras, or
/// instructions that this processor does not have.
void CheckPictures(const PicturesConfig& config);

/// Throws Error(kInvalidConfig) if a camera on the hand is inside a piece of this robot.
void CheckPictures(const PicturesConfig& config, const RobotModel& robot);
/// Throws Error(kInvalidConfig) if a camera in the world is inside the closed door of this scene.
void CheckPictures(const PicturesConfig& config, const Scene& scene, const DoorAsset& door);

/// Throws Error(kInvalidConfig) if colours are asked for of clouds that no picture shows.
void CheckPictures(const PicturesConfig& config, const CloudConfig& cloud);

/// The camera in the frame of what carries it: in the world, in the hand's frame, or the scene's.
CameraModel CameraOf(const PictureCamera& camera, const Scene& scene);
/// CameraOf() in the world, while the hand is there.
CameraModel InWorld(CameraPlace at, CameraModel camera, const RigidTransform& world_from_hand);

/// Bytes that the pictures of one decision take, and the colours of its cloud.
double PictureBytes(const PicturesConfig& config, const CameraModel& scene_camera, int point_count);

}  // namespace doorforge

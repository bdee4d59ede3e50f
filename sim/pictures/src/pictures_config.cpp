// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pictures/pictures_config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <string_view>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/rollout/solid_around.h"
#include "doorforge/sensor/scene_geometry.h"

#include "picture_room.h"

namespace doorforge {
namespace {

constexpr std::size_t kLongestName = 32;
constexpr double kWidestView = 3.1;  // [rad]

// A camera as it is where nothing is said of it. On the hand it looks past the fingers.
struct DefaultView {
  Eigen::Vector3d position_m;
  Eigen::Vector3d target_m;
  Eigen::Vector3d up;
};
DefaultView DefaultViewAt(CameraPlace place) {
  if (place == CameraPlace::kHand) return {{0.08, 0, 0.02}, {0.01, 0, 0.3}, {1, 0, 0}};
  const CameraModel camera;
  return {camera.position_m, camera.target_m, camera.up};
}

[[noreturn]] void Refuse(const std::string& where, const std::string& problem) {
  throw Error(ErrorCode::kInvalidConfig, where + ": " + problem);
}

std::string PathOf(const PictureCamera& camera) {
  return "config.pictures camera \"" + camera.name + '"';
}

Eigen::Vector3d VectorOf(const std::vector<double>& numbers, const Eigen::Vector3d& otherwise,
                         const std::string& where) {
  if (numbers.empty()) return otherwise;
  if (numbers.size() != 3)
    Refuse(where, "found " + std::to_string(numbers.size()) + " numbers, expected 3");
  const Eigen::Vector3d vector(numbers[0], numbers[1], numbers[2]);
  if (!vector.allFinite()) Refuse(where, "numbers must be finite");
  return vector;
}

void CheckName(const PictureCamera& camera, std::set<std::string>& names) {
  const bool plain = std::all_of(camera.name.begin(), camera.name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (camera.name.empty() || camera.name.size() > kLongestName || !plain)
    Refuse("config.pictures.cameras", "name \"" + camera.name +
                                          "\", expected 1 to 32 letters, digits and '_', such as "
                                          "\"wrist\"; the arrays are called after it");
  if (!names.insert(camera.name).second)
    Refuse("config.pictures.cameras", "two are called \"" + camera.name + "\"; rename one");
}

void CheckSize(const PictureCamera& camera) {
  for (const auto& [name, size] : {std::pair{"width", camera.width}, {"height", camera.height}}) {
    if (size < 1 || size > kMostPicturePixels)
      Refuse(PathOf(camera), std::string(name) + " " + std::to_string(size) + ", expected 1 to " +
                                 std::to_string(kMostPicturePixels));
  }
  if (!(camera.horizontal_fov_rad > 0 && camera.horizontal_fov_rad < kWidestView))
    Refuse(PathOf(camera), "horizontal_fov_rad must lie between 0 and 3.1");
}

// The scene's camera is set up elsewhere: what was given here would be without effect.
void CheckSceneCamera(const PictureCamera& camera) {
  PictureCamera bare;
  bare.name = camera.name;
  bare.at = camera.at;
  if (ToJson(camera) != ToJson(bare))
    Refuse(PathOf(camera),
           "at: scene is the policies' camera as it is; set config.scene.camera, or at: world");
}

void CheckView(const PictureCamera& camera) {
  const CameraModel model = CameraOf(camera, Scene{});
  const Eigen::Vector3d view = model.target_m - model.position_m;
  if (!(view.norm() > 1e-6)) Refuse(PathOf(camera), "position_m and target_m are the same point");
  if (!(view.normalized().cross(model.up.normalized()).norm() > 1e-3))
    Refuse(PathOf(camera), "it looks along `up`; turn `up` or move target_m aside");
}

// "at (0.010, 0.000, 0.020) m is inside the leaf ".
std::string InsideText(const Eigen::Vector3d& position_m, std::string_view solid) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "at (%.3f, %.3f, %.3f) m is inside the %.80s",
                position_m.x(), position_m.y(), position_m.z(), std::string(solid).c_str());
  return text.data();
}

}  // namespace

void CheckPictures(const PicturesConfig& config) {
  if (config.cameras.size() > kMostPictureCameras)
    Refuse("config.pictures.cameras", "found " + std::to_string(config.cameras.size()) +
                                          ", allowed " + std::to_string(kMostPictureCameras));
  std::set<std::string> names;
  for (const PictureCamera& camera : config.cameras) {
    CheckName(camera, names);
    if (camera.at == CameraPlace::kScene) {
      CheckSceneCamera(camera);
      continue;
    }
    CheckSize(camera);
    CheckView(camera);
  }
  const std::set<PictureStream> streams(config.streams.begin(), config.streams.end());
  if (streams.size() != config.streams.size())
    Refuse("config.pictures.streams", "one is there twice");
  if (!config.cameras.empty() && streams.empty())
    Refuse("config.pictures.streams",
           "none, so that the cameras would record nothing; name some, or no cameras");
  RequireRange("config.pictures", "samples", config.samples, 1, 256);
  if (config.instructions == PictureInstructions::kAvx512 && !IsSupported(RayIsa::kAvx512))
    Refuse("config.pictures.instructions",
           "avx512, which this processor does not have; leave it at \"usual\"");
  CheckDepthNoise(config.noise);
}

void CheckPictures(const PicturesConfig& config, const RobotModel& robot) {
  const RobotPose pose = robot.PoseAt(robot.InitialPosition(), RigidTransform::Identity());
  for (const PictureCamera& camera : config.cameras) {
    if (camera.at != CameraPlace::kHand) continue;
    const Eigen::Vector3d in_hand = CameraOf(camera, Scene{}).position_m;
    const std::string_view piece = SolidAround(pose.world_from_hand * in_hand, robot, pose);
    if (!piece.empty())
      Refuse(PathOf(camera),
             InsideText(in_hand, piece) + " of the robot, in the hand's frame; move it outside");
  }
}

void CheckPictures(const PicturesConfig& config, const Scene& scene, const DoorAsset& door) {
  for (const PictureCamera& camera : config.cameras) {
    if (camera.at != CameraPlace::kWorld) continue;
    const Eigen::Vector3d eye = CameraOf(camera, scene).position_m;
    const std::string_view solid = SolidAround(eye, scene, door);
    if (!solid.empty())
      Refuse(PathOf(camera),
             InsideText(eye, solid) + " of door \"" + door.id + "\"; move it outside");
    if (DoorWallOf(scene, door).Holds(eye.cast<float>()))
      Refuse(PathOf(camera), InsideText(eye, "wall") + " of door \"" + door.id +
                                 "\", which pictures show; move it before or behind");
  }
}

void CheckPictures(const PicturesConfig& config, const CloudConfig& cloud) {
  if (config.cloud_rgb && cloud.whole)
    Refuse("config.pictures.cloud_rgb",
           "points of whole surfaces (config.cloud.whole) lie where no camera looks and have no "
           "colours; leave one of the two out");
}

CameraModel CameraOf(const PictureCamera& camera, const Scene& scene) {
  if (camera.at == CameraPlace::kScene) return scene.camera;
  const DefaultView view = DefaultViewAt(camera.at);
  CameraModel model;
  model.position_m = VectorOf(camera.position_m, view.position_m, PathOf(camera) + " position_m");
  model.target_m = VectorOf(camera.target_m, view.target_m, PathOf(camera) + " target_m");
  model.up = VectorOf(camera.up, view.up, PathOf(camera) + " up");
  model.width = camera.width;
  model.height = camera.height;
  model.horizontal_fov_rad = camera.horizontal_fov_rad;
  return model;
}

CameraModel InWorld(CameraPlace at, CameraModel camera, const RigidTransform& world_from_hand) {
  if (at != CameraPlace::kHand) return camera;
  camera.position_m = world_from_hand * camera.position_m;
  camera.target_m = world_from_hand * camera.target_m;
  camera.up = world_from_hand.linear() * camera.up;
  return camera;
}

double PictureBytes(const PicturesConfig& config, const CameraModel& scene_camera,
                    int point_count) {
  double a_pixel = 0;
  for (const PictureStream stream : config.streams)
    a_pixel += static_cast<double>(BytesAPixel(stream));
  double pixels = 0;
  for (const PictureCamera& camera : config.cameras) {
    const bool own = camera.at == CameraPlace::kScene;
    pixels += static_cast<double>(own ? scene_camera.width : camera.width) *
              (own ? scene_camera.height : camera.height);
  }
  constexpr double kColorBytes = 3;
  return a_pixel * pixels + (config.cloud_rgb ? kColorBytes * point_count : 0);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pictures/take_pictures.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/rollout/camera_observer.h"

#include "cloud_colors.h"
#include "picture_arrays.h"
#include "picture_meshes.h"
#include "rgb_renderer.h"

namespace doorforge {
namespace {

constexpr std::size_t kLookBefore = 1000000;  // its noise is none of an episode's looks

RayIsa IsaOf(const PicturesConfig& config) {
  return config.instructions == PictureInstructions::kAvx512 ? RayIsa::kAvx512 : DefaultRayIsa();
}

class Photographer {
 public:
  Photographer(const PictureScene& scene, const PicturesConfig& config)
      : scene_(scene), config_(config), depth_(PictureMeshesOf(scene), IsaOf(config)) {
    const auto& streams = config.streams;
    shows_rgb_ = std::ranges::find(streams, PictureStream::kRgb) != streams.end();
    if (shows_rgb_ || config.cloud_rgb) rgb_.emplace(scene, config, depth_.scene());
  }

  void Take(const PictureCamera& camera, std::span<const PictureLook> looks, Pictures& pictures) {
    PictureArrays arrays(camera.name, config_.streams);
    for (std::size_t i = 0; i < looks.size(); ++i) TakeOne(camera, looks[i], i, arrays);
    arrays.MoveTo(pictures.members);
    pictures.record[camera.name] = RecordOf(camera);
  }

  void ColorClouds(std::span<const PictureLook> looks, const PicturedClouds& clouds,
                   Pictures& pictures) {
    Require(clouds.clouds.size() == looks.size(), ErrorCode::kInvalidArgument,
            "pictures: not every look has a cloud, so their points cannot have colours");
    std::vector<ColoredLook> seen(1);
    if (clouds.before != nullptr) seen.push_back(LookOfBefore(*clouds.before));
    CloudColors colors;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      seen[0] = {&looks[i].depth, ViewOf(scene_.as_calibrated), SceneRgb(looks[i], i)};
      colors.Add(*clouds.clouds[i], seen);
    }
    pictures.members.push_back(colors.Member());
  }

 private:
  // The colours of the policies' camera, which clouds and its own pictures share.
  const std::vector<std::uint8_t>& SceneRgb(const PictureLook& look, std::size_t number) {
    std::vector<std::uint8_t>& rgb = scene_rgb_[number];
    if (rgb.empty()) {
      const CameraModel& camera = scene_.scene.camera;
      rgb = rgb_->Render(camera, depth_.RenderSurfaces(camera, LinkPosesOf(look.snapshot)), number,
                         PicturePart::kSurfaces);
    }
    return rgb;
  }

  ColoredLook LookOfBefore(const RememberedLook& before) const {
    const PictureScene empty{before.scene, scene_.door, scene_.robot, false, before.as_calibrated};
    DepthCamera depth(PictureMeshesOf(empty), IsaOf(config_));
    const SurfaceImage surfaces =
        depth.RenderSurfaces(before.scene.camera, LinkPosesOf(before.snapshot));
    return {&before.depth, ViewOf(before.as_calibrated),
            RgbRenderer(empty, config_, depth.scene())
                .Render(before.scene.camera, surfaces, kLookBefore, PicturePart::kSurfaces)};
  }

  void TakeOne(const PictureCamera& camera, const PictureLook& look, std::size_t number,
               PictureArrays& arrays) {
    const RigidTransform& hand = look.snapshot.robot.world_from_hand;
    const CameraModel carried = CameraOf(camera, scene_.scene);
    const CameraModel model = InWorld(camera.at, carried, hand);
    const SurfaceImage surfaces = depth_.RenderSurfaces(model, LinkPosesOf(look.snapshot));
    std::vector<std::uint8_t> rgb;
    if (shows_rgb_) rgb = rgb_->Render(model, surfaces, number);
    if (camera.at == CameraPlace::kScene) {
      if (config_.cloud_rgb && shows_rgb_) scene_rgb_[number] = rgb;
      arrays.Add({look.depth, surfaces, WorldFromCamera(scene_.as_calibrated), rgb});
      return;
    }
    const std::string stream = "pictures/" + scene_.scene.door_id + "/" +
                               std::to_string(scene_.scene.episode) + "/" + camera.name + "/";
    const CameraModel believed = CameraWithCalibrationError(
        carried, config_.noise, Rng(scene_.scene.seed, stream + "calibration"));
    const DepthImage depth =
        WithDepthNoise(surfaces.depth, model, config_.noise,
                       Rng(scene_.scene.seed, stream + std::to_string(number)));
    arrays.Add({depth, surfaces, WorldFromCamera(InWorld(camera.at, believed, hand)), rgb});
  }

  nlohmann::ordered_json RecordOf(const PictureCamera& camera) const {
    const CameraModel model = CameraOf(camera, scene_.scene);
    const Eigen::Matrix3d intrinsics = IntrinsicMatrix(model);
    nlohmann::ordered_json matrix = nlohmann::ordered_json::array();
    for (Eigen::Index row = 0; row < 3; ++row)
      matrix.push_back({intrinsics(row, 0), intrinsics(row, 1), intrinsics(row, 2)});
    return {{"at", NameOf(camera.at)},
            {"width", model.width},
            {"height", model.height},
            {"intrinsic_matrix_px", matrix}};
  }

  const PictureScene& scene_;
  const PicturesConfig& config_;
  DepthCamera depth_;
  bool shows_rgb_ = false;
  std::optional<RgbRenderer> rgb_;
  std::map<std::size_t, std::vector<std::uint8_t>> scene_rgb_;  // by number of the look
};

}  // namespace

Pictures TakePictures(const PictureScene& scene, const PicturesConfig& config,
                      std::span<const PictureLook> looks, const PicturedClouds& clouds) {
  CheckPictures(config);
  CheckPictures(config, scene.scene, scene.door);
  Photographer photographer(scene, config);
  Pictures pictures;
  for (const PictureCamera& camera : config.cameras) photographer.Take(camera, looks, pictures);
  if (config.cloud_rgb) photographer.ColorClouds(looks, clouds, pictures);
  std::ranges::sort(pictures.members, {}, &MemberBytes::name);
  return pictures;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pictures/scene_colors.h"

#include <utility>

#include "doorforge/pictures/take_pictures.h"
#include "doorforge/rollout/camera_observer.h"

#include "picture_meshes.h"
#include "rgb_renderer.h"

namespace doorforge {
namespace {

class RenderedColors : public ColorSource {
 public:
  RenderedColors(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                 const PicturesConfig& config, bool sees_robot)
      : scene_(scene),
        seen_{scene_, door, robot, sees_robot, scene.camera},
        depth_(PictureMeshesOf(seen_)),
        rgb_(seen_, config, depth_.scene()) {}

  std::vector<std::uint8_t> ColorsAt(const SceneSnapshot& snapshot, int look) override {
    const SurfaceImage surfaces = depth_.RenderSurfaces(scene_.camera, LinkPosesOf(snapshot));
    return rgb_.Render(scene_.camera, surfaces, static_cast<std::size_t>(look),
                       PicturePart::kSurfaces);
  }

 private:
  Scene scene_;
  PictureScene seen_;
  DepthCamera depth_;
  RgbRenderer rgb_;
};

}  // namespace

ColorSources SceneColors(const DoorAsset& door, const RobotModel& robot, int samples) {
  PicturesConfig config;
  config.samples = samples;
  return [&door, &robot, config](const Scene& scene, bool sees_robot) {
    return std::make_unique<RenderedColors>(scene, door, robot, config, sees_robot);
  };
}

}  // namespace doorforge

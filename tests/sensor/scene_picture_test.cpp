// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/scene_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "shapes.h"

namespace doorforge {
namespace {

std::array<int, 3> PixelAt(const Picture& picture, int row, int column) {
  const auto i = 3 * static_cast<std::size_t>(row * picture.width + column);
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

int BrightnessAt(const Picture& picture, const CameraModel& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector3d pixel =
      IntrinsicMatrix(camera) * (WorldFromCamera(camera).inverse() * point);
  const std::array<int, 3> rgb = PixelAt(picture, static_cast<int>(pixel.y() / pixel.z()),
                                         static_cast<int>(pixel.x() / pixel.z()));
  return rgb[0] + rgb[1] + rgb[2];
}

SceneGeometry RedBox() {
  return SceneGeometry(
      {{shapes::Box({-0.2, -0.2, 0}, {0.2, 0.2, 1}), 0, PointLabel::kBody, {0.8, 0.1, 0.1}}});
}

TEST(FramingCamera, ShowsEveryVertexAndLittleMore) {
  SceneGeometry scene = RedBox();
  const std::vector<RigidTransform> poses = {Translation({3, -2, 0.5})};
  scene.MoveLinks(poses);
  const CameraModel camera = FramingCamera(scene, {.width = 320, .height = 240});
  double closest = 1e9;  // to the border of the image
  for (const Eigen::Vector3d& vertex : scene.meshes()[0].mesh.vertices) {
    const Eigen::Vector3d pixel =
        IntrinsicMatrix(camera) * (WorldFromCamera(camera).inverse() * (poses[0] * vertex));
    const double u = pixel.x() / pixel.z();
    const double v = pixel.y() / pixel.z();
    closest = std::min({closest, u, v, 320 - u, 240 - v});
  }
  EXPECT_GT(closest, 2);
  EXPECT_LT(closest, 24);
}

TEST(FramingCamera, AcceptsAnEmptyScene) {
  const CameraModel camera = FramingCamera(SceneGeometry({}));
  EXPECT_TRUE(camera.position_m.allFinite());
}

TEST(RenderPicture, ShowsColorsAndShadows) {
  SceneGeometry scene = RedBox();
  const CameraModel camera = FramingCamera(scene, {.width = 200, .height = 150, .margin = 2});
  const Picture picture = RenderPicture(scene, camera);
  ASSERT_EQ(picture.rgb.size(), 3U * 200 * 150);
  const std::array<int, 3> middle = PixelAt(picture, 75, 100);
  EXPECT_GT(middle[0], 3 * middle[1]);
  // the sun stands at +x, -y: the shadow falls to -x, +y
  const int shadow = BrightnessAt(picture, camera, {-0.45, 0.3, 0});
  const int open = BrightnessAt(picture, camera, {0.5, 0.5, 0});
  EXPECT_LT(shadow, open - 60);
}

TEST(RenderPicture, IsTheSameTwice) {
  SceneGeometry scene = RedBox();
  const CameraModel camera = FramingCamera(scene, {.width = 61, .height = 33});
  EXPECT_EQ(RenderPicture(scene, camera).rgb, RenderPicture(scene, camera).rgb);
}

// Packets of rays of which some meet nothing; the dev preset fills their memory with huge numbers.
TEST(RenderPicture, DrawsTheBorderBetweenMeshAndBackdrop) {
  SceneGeometry scene = RedBox();
  const CameraModel camera = FramingCamera(scene, {.width = 40, .height = 30, .margin = 2});
  const Picture picture = RenderPicture(scene, camera, {.sky_rays = 1, .floor = false});
  EXPECT_GT(PixelAt(picture, 0, 0)[2], 150);
  EXPECT_LT(PixelAt(picture, 15, 20)[2], 100);
}

TEST(RenderPicture, ShowsTheBackdropWhereThereIsNothing) {
  SceneGeometry scene({});
  const Picture picture = RenderPicture(scene, FramingCamera(scene, {.width = 8, .height = 8}));
  EXPECT_GT(*std::min_element(picture.rgb.begin(), picture.rgb.end()), 150);
}

TEST(RenderPicture, RefusesSettingsOutOfRange) {
  SceneGeometry scene({});
  CameraModel camera;
  EXPECT_THROW(RenderPicture(scene, camera, {.sky_rays = 0}), Error);
  EXPECT_THROW(RenderPicture(scene, camera, {.exposure = 0}), Error);
  camera.width = 0;
  EXPECT_THROW(RenderPicture(scene, camera), Error);
}

TEST(CloudPicture, DrawsPointsInTheColorOfTheirLabel) {
  LabelledCloud cloud;
  cloud.xyz = {0.01F, 0, 1.5F};
  cloud.label = {static_cast<std::uint8_t>(PointLabel::kHandle)};
  const CameraModel camera;
  const Picture picture = CloudPicture(cloud, camera);
  const Eigen::Vector3d expected = 255 * ColorOf(PointLabel::kHandle);
  const std::array<int, 3> middle = PixelAt(picture, 128, 128);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(middle[i], expected[static_cast<Eigen::Index>(i)], 40);
  EXPECT_EQ(PixelAt(picture, 200, 60), (std::array<int, 3>{255, 255, 255}));
}

TEST(CloudPicture, AcceptsAnEmptyCloudAndRefusesAMissingLabel) {
  const CameraModel camera;
  EXPECT_EQ(CloudPicture({}, camera).rgb,
            std::vector<std::uint8_t>(3UL * 256 * 256, std::uint8_t{255}));
  LabelledCloud broken;
  broken.xyz = {0, 0, 0};
  EXPECT_THROW(CloudPicture(broken, camera), Error);
}

}  // namespace
}  // namespace doorforge

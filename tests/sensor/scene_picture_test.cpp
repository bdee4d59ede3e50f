// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/scene_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/sensor/affordance_picture.h"

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

/// A wall across x with a bar before it, held in the bar's middle; the map grows along the bar.
class AffordancePictureTest : public testing::Test {
 protected:
  AffordancePictureTest()
      : camera_({{shapes::Box({-0.1, -1, 0}, {0, 1, 2}), 0, PointLabel::kBody, {0.8, 0.2, 0.1}},
                 {shapes::Box({0, -0.1, 0.99}, {0.02, 0.1, 1.01}), 0, PointLabel::kHandle}}) {
    for (int i = 0; i <= 20; ++i) {
      const float y = -0.1F + 0.01F * static_cast<float>(i);
      map_.point_xyz.insert(map_.point_xyz.end(), {0.02F, y, 1.0F});
      map_.affordance_rad.push_back(0.1F + y);
    }
    map_.contact_m = {0.02, 0, 1};
    // looks into the wall, closes up and down
    map_.world_from_tcp.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    map_.world_from_tcp.translation() = Eigen::Vector3d(0.008, 0, 1);
    CameraModel place;
    place.position_m = {1.5, 0, 1.2};
    place.width = 300;
    place.height = 240;
    view_ = CameraOn(map_, place);
  }

  std::array<int, 2> PixelOf(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d pixel =
        IntrinsicMatrix(view_) * (WorldFromCamera(view_).inverse() * point);
    return {static_cast<int>(pixel.y() / pixel.z()), static_cast<int>(pixel.x() / pixel.z())};
  }

  std::array<int, 3> ColorAt(const Picture& picture, const Eigen::Vector3d& point) const {
    const auto [row, column] = PixelOf(point);
    return PixelAt(picture, row, column);
  }

  DepthCamera camera_;
  AffordanceMap map_;
  CameraModel view_;
  std::vector<RigidTransform> poses_ = {RigidTransform::Identity()};
};

TEST_F(AffordancePictureTest, TheViewHoldsTheMapAndTheHand) {
  for (const double y : {-0.1, 0.1}) {
    for (const double x : {0.02, 0.1}) {
      const auto [row, column] = PixelOf({x, y, 1});
      EXPECT_GT(std::min({row, column, 240 - row, 300 - column}), 10);
    }
  }
}

TEST_F(AffordancePictureTest, TheHandleHasTheMapsColoursAndTheRestNone) {
  const Picture picture = AffordancePicture(camera_, poses_, view_, map_);
  EXPECT_EQ(picture.width, 300);
  EXPECT_GT(picture.height, 240) << "the colour scale";
  const auto least = ColorAt(picture, {0.02, -0.097, 1});  // viridis: dark violet to yellow
  EXPECT_GT(least[2], least[1] + 30);
  EXPECT_LT(least[0] + least[1], 110);
  const auto most = ColorAt(picture, {0.02, 0.097, 1});
  EXPECT_GT(std::min(most[0], most[1]), most[2] + 80);
  const auto wall = ColorAt(picture, {0, 0.05, 1.08});
  EXPECT_EQ(wall[0], wall[2]) << "a red wall is grey here";
  const auto finger = ColorAt(picture, {0.008 + 0.02, 0, 1.04});
  EXPECT_GT(finger[0], finger[2] + 100) << "the hand is red";
  EXPECT_EQ(AffordancePicture(camera_, poses_, view_, map_).rgb, picture.rgb);
}

TEST_F(AffordancePictureTest, MapsThatCannotBeDrawnAreRefused) {
  map_.affordance_rad.pop_back();
  EXPECT_THROW(AffordancePicture(camera_, poses_, view_, map_), Error);
  map_.affordance_rad.push_back(std::nanf(""));
  EXPECT_THROW(CameraOn(map_, view_), Error);
  EXPECT_THROW(CameraOn(AffordanceMap{}, view_), Error);
}

}  // namespace
}  // namespace doorforge

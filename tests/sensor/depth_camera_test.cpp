// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/depth_camera.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>
#include <immintrin.h>

#include "doorforge/core/error.h"

#include "shapes.h"

namespace doorforge {
namespace {

const std::vector<RigidTransform> kStill(8, RigidTransform::Identity());

// Looks along -x from x = 2 at height 1.5.
CameraModel FrontCamera(int width = 64, int height = 64) {
  CameraModel camera;
  camera.position_m = {2, 0, 1.5};
  camera.target_m = {0, 0, 1.5};
  camera.width = width;
  camera.height = height;
  return camera;
}

std::size_t PixelAt(const DepthImage& image, int row, int column) {
  return static_cast<std::size_t>(row * image.width + column);
}

TEST(DepthCamera, MeasuresAWallAlongTheOpticalAxis) {
  DepthCamera camera({{shapes::Wall(0.25, 5), 0, PointLabel::kBody}});
  const DepthImage image = camera.Render(FrontCamera(), kStill);
  for (const float depth : image.depth_m) ASSERT_EQ(depth, 1.75F);
  for (const std::uint8_t label : image.label) ASSERT_EQ(label, 0);
}

TEST(DepthCamera, SeesNothingAsInfinity) {
  DepthCamera camera({});
  const DepthImage image = camera.Render(FrontCamera(5, 3), kStill);
  EXPECT_EQ(image.depth_m, std::vector<float>(15, std::numeric_limits<float>::infinity()));
  EXPECT_EQ(image.link, std::vector<std::int16_t>(15, -1));
  EXPECT_EQ(image.label, std::vector<std::uint8_t>(15, 4));
}

// Rays are cast 4 x 4 at a time, also over the image's right and lower edge.
TEST(DepthCamera, AnImageOfAnySizeHasNoPixelFromBeyondItsEdge) {
  for (const auto& [width, height] : {std::pair{41, 30}, {6, 7}, {1, 1}, {3, 65}}) {
    DepthCamera camera({{shapes::Box({0, 0.02, -90}, {0.1, 9, 90}), 0, PointLabel::kHandle}});
    const DepthImage image = camera.Render(FrontCamera(width, height), kStill);
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const double right = (column + 0.5 - width / 2.0) / (width / 2.0);  // at depth 1
        const bool sees = right * 1.9 > 0.02;
        EXPECT_EQ(image.label[PixelAt(image, row, column)], sees ? 1 : 4)
            << width << " x " << height << ": " << row << ", " << column;
      }
    }
  }
}

TEST(DepthCamera, SurfacesAreWhatTheDepthIsOf) {
  const TriangleMesh soup = shapes::Soup(300, 5);
  DepthCamera camera({{shapes::Wall(-1, 5), 0, PointLabel::kBody}, {soup, 1, PointLabel::kHandle}});
  const CameraModel model = FrontCamera(50, 31);
  const SurfaceImage surfaces = camera.RenderSurfaces(model, kStill);
  const DepthImage image = camera.Render(model, kStill);
  EXPECT_EQ(surfaces.depth.depth_m, image.depth_m);
  EXPECT_EQ(surfaces.depth.link, image.link);
  const RigidTransform pose = WorldFromCamera(model);
  const double focal = IntrinsicMatrix(model)(0, 0);
  int of_soup = 0;
  for (std::size_t i = 0; i < image.link.size(); ++i) {
    ASSERT_EQ(surfaces.mesh[i], image.link[i]);
    if (surfaces.mesh[i] < 0) continue;
    of_soup += surfaces.mesh[i];
    const VisibleMesh& mesh = camera.scene().meshes()[static_cast<std::size_t>(surfaces.mesh[i])];
    const Eigen::Vector3i& triangle = mesh.mesh.triangles[surfaces.triangle[i]];
    const auto corner = [&](int k) {
      return mesh.mesh.vertices[static_cast<std::size_t>(triangle[k])];
    };
    const Eigen::Vector3d in_camera((static_cast<double>(i % 50) + 0.5 - 25) / focal,
                                    (static_cast<double>(i / 50) + 0.5 - 15.5) / focal, 1);
    const Eigen::Vector3d direction = pose.linear() * in_camera;
    const double u = static_cast<double>(surfaces.u[i]);
    const double v = static_cast<double>(surfaces.v[i]);
    EXPECT_LT((pose.translation() + static_cast<double>(image.depth_m[i]) * direction -
               ((1 - u - v) * corner(0) + u * corner(1) + v * corner(2)))
                  .norm(),
              1e-3);
    const Eigen::Vector3d normal = surfaces.normal[i].cast<double>();
    EXPECT_LT(normal.dot(direction), 0);
    EXPECT_NEAR(
        std::fabs(normal.dot((corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized())), 1,
        1e-6);
  }
  EXPECT_GT(of_soup, 50);
}

TEST(DepthCamera, PutsWorldYToTheRightAndWorldZUp) {
  // seen against -x, world +y is on the right
  DepthCamera camera({{shapes::Box({0, 0.2, 1.7}, {0.1, 0.6, 2.1}), 0, PointLabel::kHandle}});
  const DepthImage image = camera.Render(FrontCamera(), kStill);
  EXPECT_EQ(image.label[PixelAt(image, 26, 38)], 1);
  EXPECT_EQ(image.label[PixelAt(image, 26, 25)], 4);
  EXPECT_EQ(image.label[PixelAt(image, 37, 38)], 4);
}

TEST(DepthCamera, AgreesWithTestingEveryTriangle) {
  const TriangleMesh soup = shapes::Soup(400, 11);
  const RigidTransform pose =
      Translation({0.1, 0.2, 1.5}) * RotationAbout(Eigen::Vector3d(1, 2, 3).normalized(), 0.7);
  TriangleMesh placed = soup;
  for (Eigen::Vector3d& vertex : placed.vertices) vertex = pose * vertex;
  const CameraModel model = FrontCamera(61, 47);  // not a multiple of the packets' size
  DepthCamera camera({{soup, 0, PointLabel::kBody}});
  const DepthImage image = camera.Render(model, std::vector<RigidTransform>{pose});

  const RigidTransform world_from_camera = WorldFromCamera(model);
  const Eigen::Matrix3d inverse_intrinsics = IntrinsicMatrix(model).inverse();
  int hits = 0;
  int different = 0;
  for (int row = 0; row < model.height; ++row) {
    for (int column = 0; column < model.width; ++column) {
      const Eigen::Vector3d direction =
          world_from_camera.linear() *
          (inverse_intrinsics * Eigen::Vector3d(column + 0.5, row + 0.5, 1));
      const double expected = shapes::NearestHit(placed, model.position_m, direction);
      const double found = image.depth_m[PixelAt(image, row, column)];
      hits += std::isfinite(expected) ? 1 : 0;
      const bool same =
          std::isfinite(expected) ? std::fabs(expected - found) < 1e-5 : !std::isfinite(found);
      different += same ? 0 : 1;
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_LE(different, 2);  // rays that graze an edge
}

TEST(DepthCamera, LetsTheRobotHideTheDoorAndTheDoorTheRobot) {
  DepthCamera camera({{shapes::Box({-0.02, -0.5, 0}, {0.02, 0.5, 3}), 0, PointLabel::kBody},
                      {shapes::Box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), 1, PointLabel::kRobot}});
  const std::vector<RigidTransform> in_front = {RigidTransform::Identity(),
                                                Translation({1, 0, 1.5})};
  const std::vector<RigidTransform> behind = {RigidTransform::Identity(),
                                              Translation({-1, 0, 1.5})};
  const DepthImage front = camera.Render(FrontCamera(), in_front);
  const DepthImage back = camera.Render(FrontCamera(), behind);
  const std::size_t middle = PixelAt(front, 32, 32);
  EXPECT_EQ(front.label[middle], 3);
  EXPECT_EQ(front.link[middle], 1);
  EXPECT_FLOAT_EQ(front.depth_m[middle], 0.9F);
  EXPECT_EQ(back.label[middle], 0);
  EXPECT_FLOAT_EQ(back.depth_m[middle], 1.98F);
  EXPECT_EQ(std::count(back.label.begin(), back.label.end(), 3), 0);
}

TEST(DepthCamera, FollowsALinkThatTurns) {
  // a leaf hinged at y = -0.5 that opens by 30 degrees towards the camera
  DepthCamera camera({{shapes::Box({0, 0, 0}, {0, 1, 3}), 0, PointLabel::kBody}});
  const double angle = 0.5235987755982988;
  const std::vector<RigidTransform> open = {Translation({0, -0.5, 0}) *
                                            RotationAbout(Eigen::Vector3d::UnitZ(), -angle)};
  const DepthImage image = camera.Render(FrontCamera(), open);
  // on the optical axis: y = 0 is reached on the leaf at x = 0.5 tan(30 degrees)
  const double expected = 2 - 0.5 * std::tan(angle);
  const double pixel = 2.0 / 64;  // width of a pixel at depth 1
  EXPECT_NEAR(image.depth_m[PixelAt(image, 32, 32)], expected, pixel * expected);
}

TEST(DepthCamera, SeesTrianglesFromBothSides) {
  TriangleMesh reversed = shapes::Wall(0.25, 5);
  for (Eigen::Vector3i& triangle : reversed.triangles) std::swap(triangle[0], triangle[1]);
  DepthCamera camera({{reversed, 0, PointLabel::kBody}});
  for (const float depth : camera.Render(FrontCamera(), kStill).depth_m) ASSERT_EQ(depth, 1.75F);
}

TEST(DepthCamera, GivesTheSameBytesAgainAndInParallel) {
  const std::vector<VisibleMesh> meshes = {{shapes::Soup(2000, 3), 0, PointLabel::kBody},
                                           {shapes::Soup(2000, 4), 1, PointLabel::kRobot}};
  const std::vector<RigidTransform> poses = {Translation({0, 0, 1.4}), Translation({0.3, 0, 1.6})};
  std::vector<DepthImage> images(4);
  {
    std::vector<std::jthread> threads;
    for (DepthImage& image : images) {
      threads.emplace_back([&] {
        DepthCamera camera(meshes);
        camera.Render(FrontCamera(32, 32), kStill);  // another camera and pose in between
        image = camera.Render(CameraModel{}, poses);
      });
    }
  }
  for (const DepthImage& image : images) {
    EXPECT_EQ(image.depth_m, images[0].depth_m);
    EXPECT_EQ(image.label, images[0].label);
  }
}

TEST(DepthCamera, HardlyDependsOnTheInstructionSet) {
  const std::vector<VisibleMesh> meshes = {{shapes::Soup(3000, 5), 0, PointLabel::kBody}};
  const std::vector<RigidTransform> poses = {Translation({0, 0, 1.5})};
  const DepthImage reference = DepthCamera(meshes, RayIsa::kSse42).Render(CameraModel{}, poses);
  for (const RayIsa isa : {RayIsa::kAvx2, RayIsa::kAvx512}) {
    if (!IsSupported(isa)) continue;
    const DepthImage image = DepthCamera(meshes, isa).Render(CameraModel{}, poses);
    int different = 0;
    for (std::size_t i = 0; i < image.depth_m.size(); ++i)
      different += image.depth_m[i] != reference.depth_m[i] ? 1 : 0;
    RecordProperty(std::string(NameOf(isa)), different);
    EXPECT_LE(different, 6) << NameOf(isa);  // of 65,536 pixels: rays through edges
  }
}

TEST(DepthCamera, RestoresTheThreadsFloatingPointMode) {
  const unsigned before = _mm_getcsr();
  DepthCamera camera({{shapes::Wall(0.25, 5), 0, PointLabel::kBody}});
  camera.Render(FrontCamera(), kStill);
  EXPECT_EQ(_mm_getcsr() & 0x8040U, before & 0x8040U);
}

TEST(DepthCamera, RefusesImagesWithoutPixelsAndViewsAlongUp) {
  DepthCamera camera({});
  EXPECT_THROW(camera.Render(FrontCamera(0, 4), kStill), Error);
  EXPECT_THROW(camera.Render(FrontCamera(4, 9000), kStill), Error);
  CameraModel above = FrontCamera();
  above.target_m = above.position_m + Eigen::Vector3d(0, 0, 1);
  EXPECT_THROW(camera.Render(above, kStill), Error);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/npy.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/ray_packet.h"
#include "doorforge/sensor/scene_geometry.h"

#include "robot_sight_fixture.h"

// What an answer's picture shows, and what a lens makes of it.
namespace doorforge {
namespace {

namespace fs = std::filesystem;

TEST_F(RobotSightTest, ThePictureOfAnAnswerIsNotReplacedUnasked) {
  const fs::path picture = folder_ / "answer.png";
  const std::string draw = "--least-gain off --picture " + picture.string();
  EXPECT_EQ(Open(folder_ / "opener", Depth(0), draw).code, 0);
  const std::string first = ReadFile(picture);
  EXPECT_EQ(first.substr(1, 3), "PNG");
  const ProgramAnswer again = Open(folder_ / "opener", Depth(1), draw);
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.text.find("--overwrite"), std::string::npos) << again.text;
  EXPECT_EQ(ReadFile(picture), first);
  EXPECT_EQ(Open(folder_ / "opener", Depth(1), draw + " --overwrite").code, 0);
  EXPECT_NE(ReadFile(picture), first);
}

TEST_F(RobotSightTest, ThePictureShowsWhereTheHandIsToGo) {
  const fs::path picture = folder_ / "drawn.png";
  const ProgramAnswer answer =
      Open(folder_ / "opener", Depth(0), "--least-gain off --picture " + picture.string(),
           "2>/dev/null");
  ASSERT_EQ(answer.code, 0);
  const RigidTransform hand =
      TransformFromJson(Json::parse(answer.text)["world_from_hand"], "hand");
  // the drawn hand reaches from the tool centre 12 cm back
  const Eigen::Vector3d middle = hand * robot_.hand_from_tcp() * Eigen::Vector3d(0, 0, -0.05);
  const Eigen::Vector3d pixel =
      IntrinsicMatrix(scene_.camera) * (WorldFromCamera(scene_.camera).inverse() * middle);
  // the left of two tiles of 640 pixels holds the whole picture, behind a margin of a few pixels
  const double scale = 640.0 / scene_.camera.width;
  const ColoredPixels red = PixelsOf(picture, "220 40 40");
  EXPECT_GT(red.count, 30);
  EXPECT_NEAR(red.middle.x(), scale * pixel.x() / pixel.z(), 20);
  EXPECT_NEAR(red.middle.y(), scale * pixel.y() / pixel.z(), 20);
}

// A lens as ROS's plumb_bob describes it, in the words of its makers, of a camera that stands where
// the episode's does.
struct DistortedCamera {
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 288;
  static constexpr double kFocal = 130;
  static constexpr double kCx = 161.2;  // of the first pixel's centre, 0
  static constexpr double kCy = 139.6;
  static constexpr double kK1 = -0.16;
  static constexpr double kK2 = 0.03;
  static constexpr double kP1 = 0.002;
  static constexpr double kP2 = -0.003;

  static Eigen::Vector2d Bent(const Eigen::Vector2d& p) {
    const double r2 = p.squaredNorm();
    return Eigen::Vector2d(2 * kP1 * p.x() * p.y() + kP2 * (r2 + 2 * p.x() * p.x()),
                           kP1 * (r2 + 2 * p.y() * p.y()) + 2 * kP2 * p.x() * p.y());
  }

  // OpenCV's way: again and again what the distortion at the last guess leaves over.
  static Eigen::Vector3d DirectionOf(int column, int row) {
    const Eigen::Vector2d seen((column - kCx) / kFocal, (row - kCy) / kFocal);
    Eigen::Vector2d ideal = seen;
    for (int i = 0; i < 2000; ++i) {
      const double r2 = ideal.squaredNorm();
      const Eigen::Vector2d next = (seen - Bent(ideal)) / (1 + kK1 * r2 + kK2 * r2 * r2);
      const bool is_done = (next - ideal).norm() < 1e-14;
      ideal = next;
      if (is_done) break;
    }
    return ideal.homogeneous();
  }

  static std::string Info(const CameraModel& camera) {
    return "image_width: 320\nimage_height: 288\ndistortion_model: plumb_bob\n"
           "camera_matrix: {rows: 3, cols: 3, data: [130, 0, 161.2, 0, 130, 139.6, 0, 0, 1]}\n"
           "distortion_coefficients: {rows: 1, cols: 5, data: [-0.16, 0.03, 0.002, -0.003, 0]}\n"
           "rectified: false\nworld_from_camera: " +
           JsonText(TransformToJson(WorldFromCamera(camera))) + "\n";
  }
};

/// What a real sensor would write, and where the points really are.
struct DistortedSight {
  std::vector<float> depth_m;
  LabelledCloud points;
};

DistortedSight LookThroughLens(const CameraModel& camera, const std::vector<RigidTransform>& links,
                               const CloudConfig& crop) {
  SceneGeometry scene(VisibleMeshesOf(MakePrimitiveDoor({}), LoadMobileFranka()));
  scene.MoveLinks(links);
  const RigidTransform pose = WorldFromCamera(camera);
  DistortedSight sight;
  for (int row = 0; row < DistortedCamera::kHeight; ++row) {
    for (int begin = 0; begin < DistortedCamera::kWidth; begin += 16) {
      RayPacket packet;
      for (int i = 0; i < 16; ++i)
        packet.Set(static_cast<std::size_t>(i), pose.translation().cast<float>(),
                   (pose.linear() * DistortedCamera::DirectionOf(begin + i, row)).cast<float>(),
                   100);
      const PacketHits hits = CastRays(scene, packet);
      for (std::size_t i = 0; i < 16; ++i) {
        const bool is_hit = (hits.hits >> i & 1U) != 0;
        sight.depth_m.push_back(is_hit ? hits.distance[i] : std::nanf(""));
        if (!is_hit || hits.distance[i] >= static_cast<float>(crop.max_depth_m)) continue;
        const Eigen::Vector3f at(packet.direction_x[i], packet.direction_y[i],
                                 packet.direction_z[i]);
        const Eigen::Vector3f point = pose.translation().cast<float>() + hits.distance[i] * at;
        if (point.z() <= static_cast<float>(crop.min_height_m)) continue;
        sight.points.xyz.insert(sight.points.xyz.end(), {point.x(), point.y(), point.z()});
      }
    }
  }
  return sight;
}

TEST_F(RobotSightTest, APictureThroughALensIsDecidedOnAsThePinholesIs) {
  CommitFile(folder_ / "lens.yaml", DistortedCamera::Info(scene_.camera));
  std::string pinhole = DistortedCamera::Info(scene_.camera);
  pinhole.replace(pinhole.find("-0.16, 0.03, 0.002, -0.003"), 26, "0, 0, 0, 0");
  CommitFile(folder_ / "no_lens.yaml", pinhole);
  const CloudConfig crop;
  const DistortedSight sight = LookThroughLens(scene_.camera, links_[0], crop);
  CommitFile(folder_ / "lens.npy",
             MakeNpy<float>(sight.depth_m, {DistortedCamera::kHeight, DistortedCamera::kWidth}));
  // the cloud is where the rays met the scene, and would not be without the lens
  const auto farthest = [&](const char* file) {
    const CalibratedCamera camera = ReadCalibratedCamera(folder_ / file);
    const LabelledCloud cloud =
        CropCloud(ReadDepthPicture(folder_ / "lens.npy", camera), camera, crop);
    double most = 0;
    for (std::size_t i = 0; i < std::min(cloud.xyz.size(), sight.points.xyz.size()); ++i)
      most = std::max<double>(most, std::fabs(cloud.xyz[i] - sight.points.xyz[i]));
    return std::pair(cloud.xyz.size() == sight.points.xyz.size(), most);
  };
  EXPECT_TRUE(farthest("lens.yaml").first);
  EXPECT_LT(farthest("lens.yaml").second, 5e-6);
  EXPECT_GT(farthest("no_lens.yaml").second, 0.05);
  // and the decision that of the pinhole's picture, but for which points are sampled
  const auto decide = [&](const std::string& camera, const fs::path& depth) {
    const ProgramAnswer answer = RunAct(
        With(camera, "--stage open --depth " + depth.string() + " --state " + State(0).string() +
                         " --picture " + (folder_ / "lens.png").string() + " --overwrite"),
        "2>/dev/null");
    EXPECT_EQ(answer.code, 0) << answer.text;
    return TransformFromJson(Json::parse(answer.text)["world_from_hand"], "hand");
  };
  const RigidTransform expected = decide("camera.yaml", Depth(0));
  const RigidTransform seen = decide("lens.yaml", folder_ / "lens.npy");
  EXPECT_LT((seen.translation() - expected.translation()).norm(), 0.003);
  EXPECT_LT(RotationVector(seen.linear().transpose() * expected.linear()).norm(),
            3 * 3.14159265 / 180);
  // the drawn hand is where the lens shows it
  const Eigen::Vector3d middle = seen * robot_.hand_from_tcp() * Eigen::Vector3d(0, 0, -0.05);
  const Eigen::Vector2d ideal = (WorldFromCamera(scene_.camera).inverse() * middle).hnormalized();
  const double r2 = ideal.squaredNorm();
  const Eigen::Vector2d pixel =
      DistortedCamera::kFocal *
          (ideal * (1 + DistortedCamera::kK1 * r2 + DistortedCamera::kK2 * r2 * r2) +
           DistortedCamera::Bent(ideal)) +
      Eigen::Vector2d(DistortedCamera::kCx + 0.5, DistortedCamera::kCy + 0.5);
  const ColoredPixels red = PixelsOf(folder_ / "lens.png", "220 40 40");
  EXPECT_GT(red.count, 30);
  EXPECT_NEAR(red.middle.x(), 10 + 2 * pixel.x(), 20);
  EXPECT_NEAR(red.middle.y(), 10 + 32 + 2 * pixel.y(), 20);
}

Picture Plain(const std::array<std::uint8_t, 3>& rgb) {
  Picture picture{256, 256, {}};
  for (int i = 0; i < 256 * 256; ++i) picture.rgb.insert(picture.rgb.end(), rgb.begin(), rgb.end());
  return picture;
}

TEST_F(RobotSightTest, TheAnswerIsDrawnIntoAPictureInColoursOfTheSameSize) {
  const fs::path picture = folder_ / "on_colours.png";
  WritePng(folder_ / "blue.png", Plain({0, 0, 250}));
  const std::string draw = "--least-gain off --picture " + picture.string() + " --color ";
  EXPECT_EQ(Open(folder_ / "opener", Depth(0), draw + (folder_ / "blue.png").string()).code, 0);
  EXPECT_GT(PixelsOf(picture, "0 0 250").count, 4 * 4096) << "what the policy is given";
  WritePng(folder_ / "small.png", {1, 1, {0, 0, 250}});
  const ProgramAnswer small =
      Open(folder_ / "opener", Depth(0), draw + (folder_ / "small.png").string() + " --overwrite");
  EXPECT_EQ(small.code, 2);
  EXPECT_NE(small.text.find("register"), std::string::npos) << small.text;
}

TEST_F(RobotSightTest, APolicyThatReadsColoursIsGivenThem) {
  WriteUntrained(folder_ / "colored", "open", /*colors=*/true);
  const auto pose = [&](const std::string& color) {
    const ProgramAnswer answer =
        Open(folder_ / "colored", Depth(0), "--least-gain off" + color, "2>/dev/null");
    EXPECT_EQ(answer.code, 0) << answer.text;
    return nlohmann::json::parse(answer.text).at("world_from_hand").dump();
  };
  const ProgramAnswer bare = Open(folder_ / "colored", Depth(0), "--least-gain off");
  EXPECT_EQ(bare.code, 2);
  EXPECT_NE(bare.text.find("--color"), std::string::npos) << bare.text;
  WritePng(folder_ / "blue.png", Plain({0, 0, 250}));
  WritePng(folder_ / "red.png", Plain({250, 0, 0}));
  const std::string blue = pose(" --color " + (folder_ / "blue.png").string());
  EXPECT_EQ(pose(" --color " + (folder_ / "blue.png").string()), blue);
  EXPECT_NE(pose(" --color " + (folder_ / "red.png").string()), blue);
}

}  // namespace
}  // namespace doorforge

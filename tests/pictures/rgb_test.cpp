// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Colours of pictures.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <thread>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/pictures/take_pictures.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_geometry.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

struct ColorSetting {
  RobotModel robot = LoadMobileFranka();
  DoorAsset door = MakePrimitiveDoor({});
  Scene scene = PlaceRobotBase(robot, SampleScene(door, 1, 0), door);
  PicturesConfig config;

  ColorSetting() {
    config.cameras.resize(1);
    config.cameras[0].name = "front";
    config.cameras[0].width = config.cameras[0].height = 96;
    config.streams = {PictureStream::kRgb, PictureStream::kLabel, PictureStream::kDepth32};
  }

  std::map<std::string, std::string> Take(double hinge_rad = 0.3) const {
    PictureLook look;
    look.snapshot.robot = robot.PoseAt(StartPosition(scene, robot), scene.world_from_robot_base);
    look.snapshot.door = DoorFromLinks(door, hinge_rad, 0);
    for (RigidTransform& pose : look.snapshot.door) pose = scene.world_from_door * pose;
    const Pictures pictures =
        TakePictures({scene, door, robot, true, scene.camera}, config, std::span(&look, 1));
    std::map<std::string, std::string> members;
    for (const MemberBytes& member : pictures.members) members[member.name] = member.bytes;
    return members;
  }
};

// The values behind the header.
std::vector<int> PixelsOf(const std::map<std::string, std::string>& members,
                          const std::string& name) {
  const std::string& bytes = members.at(name);
  std::vector<int> pixels;
  const std::size_t count = 96U * 96U * (name.starts_with("rgb") ? 3 : 1);
  for (std::size_t i = bytes.size() - count; i < bytes.size(); ++i)
    pixels.push_back(static_cast<unsigned char>(bytes[i]));
  return pixels;
}

double MeanDifference(const std::vector<int>& a, const std::vector<int>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

TEST(PictureColors, FewRaysGiveNearlyWhatManyGive) {
  ColorSetting setting;
  const auto with = [&](int samples) {
    setting.config.samples = samples;
    return PixelsOf(setting.Take(), "rgb_front.npy");
  };
  const std::vector<int> many = with(256);
  EXPECT_LT(MeanDifference(with(16), many), 1.0);
  EXPECT_LT(MeanDifference(with(1), many), 4.0);
}

double LinearOf(int srgb) {
  const double value = srgb / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// A value of the small picture has sixteen in one four times as wide; this is what they average to,
// and how far they lie apart, in linear light.
struct Averaged {
  double mean = 0;
  double range = 0;
};
std::vector<Averaged> AveragesOf(const std::string& large) {
  constexpr std::size_t kSide = 4 * 96;
  const std::size_t begin = large.size() - 3 * kSide * kSide;
  std::vector<Averaged> averages;
  for (std::size_t i = 0; i < 3UL * 96 * 96; ++i) {
    std::array<double, 16> values;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::size_t row = 4 * (i / 3 / 96) + k / 4;
      const std::size_t column = 4 * (i / 3 % 96) + k % 4;
      values[k] =
          LinearOf(static_cast<unsigned char>(large[begin + 3 * (row * kSide + column) + i % 3]));
    }
    const auto [least, most] = std::ranges::minmax(values);
    averages.push_back({std::accumulate(values.begin(), values.end(), 0.0) / 16, most - least});
  }
  return averages;
}

// Sixteen rays of a pixel go through the middles of sixteen pixels of a picture four times as wide.
TEST(PictureColors, OfEdgesAreWhatALargerPictureAveragesTo) {
  ColorSetting setting;
  const std::vector<int> sixteen = PixelsOf(setting.Take(), "rgb_front.npy");
  setting.config.samples = 1;
  const std::vector<int> one = PixelsOf(setting.Take(), "rgb_front.npy");
  setting.config.cameras[0].width = setting.config.cameras[0].height = 4 * 96;
  const std::vector<Averaged> averages = AveragesOf(setting.Take().at("rgb_front.npy"));
  const auto off = [&](const std::vector<int>& rgb) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rgb.size(); ++i)
      count += averages[i].range > 0.2 && std::fabs(LinearOf(rgb[i]) - averages[i].mean) > 0.1;
    return count;
  };
  const auto edges = static_cast<std::size_t>(
      std::ranges::count_if(averages, [](const Averaged& average) { return average.range > 0.2; }));
  ASSERT_GT(edges, 300U);
  EXPECT_LT(off(sixteen), edges / 12);
  EXPECT_GT(off(one), edges / 3);
}

// A picture of two pixels, red and blue, on the leaf's front: the author's surface lies a few
// millimetres off the closed mesh, as a repair leaves it.
VisualMesh RedAndBlueFront(const TriangleMesh& leaf) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : leaf.vertices) box.extend(vertex);
  VisualMesh drawn;
  for (const double z : {box.min().z(), box.max().z()}) {
    for (const double y : {box.min().y(), box.max().y()}) {
      drawn.vertices.emplace_back(box.max().x() - 0.003, y, z);
      drawn.texcoords.emplace_back(y == box.min().y() ? 0.0 : 1.0, z == box.min().z() ? 0.0 : 1.0);
    }
  }
  VisualSurface surface;
  surface.material.name = "front";
  surface.material.color_rgba = {1, 1, 1, 1};
  surface.material.texture = MakeVisualTexture(EncodePng({2, 1, {255, 0, 0, 0, 0, 255}}));
  surface.triangles = {{0, 1, 2}, {1, 3, 2}};
  surface.texcoords = surface.triangles;
  drawn.surfaces = {surface};
  return drawn;
}

TEST(PictureColors, ShowTheTexturesThatAuthorsDrew) {
  ColorSetting setting;
  DoorGeometry& leaf = setting.door.links[kLeafLink].geometry.at(0);
  leaf.visual = RedAndBlueFront(leaf.mesh);
  const auto members = setting.Take(0);
  const std::vector<int> rgb = PixelsOf(members, "rgb_front.npy");
  const std::vector<int> label = PixelsOf(members, "label_front.npy");
  std::map<bool, std::vector<std::size_t>> columns;  // where red, and where blue, is
  std::size_t body = 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label[i] != static_cast<int>(PointLabel::kBody)) continue;
    ++body;
    const int red = rgb[3 * i];
    const int blue = rgb[3 * i + 2];
    if (std::max(red, blue) > 3 * std::min(red, blue) && rgb[3 * i + 1] < std::max(red, blue) / 2)
      columns[red > blue].push_back(i % 96);
  }
  // all but what is seen of the edges of the leaf, half of it of each
  EXPECT_GT(columns[true].size() + columns[false].size(), body * 8 / 10);
  EXPECT_GT(columns[true].size(), body / 4);
  EXPECT_GT(columns[false].size(), body / 4);
  const auto mean = [](const std::vector<std::size_t>& all) {
    double sum = 0;
    for (const std::size_t one : all) sum += static_cast<double>(one);
    return sum / static_cast<double>(all.size());
  };
  // who looks at the door has the world's y to the right
  EXPECT_LT(mean(columns[true]) + 5, mean(columns[false]));
}

// A void would be of one colour, or black.
TEST(PictureColors, ThereIsARoomAroundTheDoor) {
  const ColorSetting setting;
  const auto members = setting.Take();
  const std::vector<int> rgb = PixelsOf(members, "rgb_front.npy");
  const std::vector<int> label = PixelsOf(members, "label_front.npy");
  std::map<int, int> shades;
  int unseen = 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label[i] != kNothingSeen) continue;
    ++unseen;
    ++shades[rgb[3 * i + 1]];
    EXPECT_GT(rgb[3 * i + 1], 5);
  }
  ASSERT_GT(unseen, 500);
  EXPECT_GT(shades.size(), 20U);
  for (const auto& [shade, count] : shades) EXPECT_LT(count, unseen / 2) << shade;
}

TEST(PictureColors, AppearanceChangesColorsByItsOwnStreamAndNothingElse) {
  ColorSetting setting;
  std::map<SceneAppearance, std::vector<int>> rgb;
  const auto plain = setting.Take();
  for (const auto& [appearance, name] : kSceneAppearances) {
    setting.scene.appearance = appearance;
    const auto members = setting.Take();
    for (const char* other : {"label_front.npy", "depth32_front.npy", "pose_front.npy"})
      EXPECT_EQ(members.at(other), plain.at(other)) << name;
    rgb[appearance] = PixelsOf(members, "rgb_front.npy");
    EXPECT_EQ(setting.Take().at("rgb_front.npy"), members.at("rgb_front.npy"));
  }
  EXPECT_GT(MeanDifference(rgb[SceneAppearance::kOff], rgb[SceneAppearance::kColour]), 8);
  EXPECT_GT(MeanDifference(rgb[SceneAppearance::kFull], rgb[SceneAppearance::kColour]), 4);
  setting.scene.episode = 1;
  EXPECT_GT(MeanDifference(PixelsOf(setting.Take(), "rgb_front.npy"), rgb[SceneAppearance::kFull]),
            8);
}

// AVX-512 is another implementation of the same rays.
TEST(PictureColors, AreNearlyTheSameWithTheWidestInstructions) {
  ColorSetting setting;
  setting.scene.appearance = SceneAppearance::kFull;
  const auto usual = setting.Take();
  setting.config.instructions = PictureInstructions::kAvx512;
  if (!IsSupported(RayIsa::kAvx512)) {
    EXPECT_THROW(setting.Take(), Error);
    return;
  }
  const auto widest = setting.Take();
  for (const char* member : {"rgb_front.npy", "label_front.npy"}) {
    const std::vector<int> a = PixelsOf(usual, member);
    const std::vector<int> b = PixelsOf(widest, member);
    std::size_t others = 0;
    for (std::size_t i = 0; i < a.size(); ++i) others += a[i] != b[i] ? 1 : 0;
    EXPECT_LE(others, a.size() / 1000) << member;
  }
}

TEST(PictureColors, AreTheSameInAnyThread) {
  ColorSetting setting;
  setting.scene.appearance = SceneAppearance::kFull;
  const auto here = setting.Take();
  std::map<std::string, std::string> there;
  std::thread([&] { there = setting.Take(); }).join();
  EXPECT_TRUE(here == there);
}

}  // namespace
}  // namespace doorforge

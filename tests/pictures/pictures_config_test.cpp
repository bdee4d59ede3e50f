// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pictures/pictures_config.h"

#include <functional>

#include <gtest/gtest.h>

#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

PicturesConfig WithCamera(const PictureCamera& camera) {
  PicturesConfig config;
  config.cameras = {camera};
  return config;
}

// What is refused as a setting, or "accepted".
std::string RefusalOf(const std::function<void()>& check) {
  try {
    check();
  } catch (const Error& error) {
    return error.code() == ErrorCode::kInvalidConfig ? error.what() : "another code";
  }
  return "accepted";
}

std::string RefusalOf(const PictureCamera& camera) {
  return RefusalOf([&] { CheckPictures(WithCamera(camera)); });
}

void ExpectNames(const std::string& refusal, const std::string& what) {
  EXPECT_NE(refusal.find(what), std::string::npos) << refusal;
}

PictureCamera Named(const std::string& name, CameraPlace at) {
  PictureCamera camera;
  camera.name = name;
  camera.at = at;
  return camera;
}

TEST(PicturesConfig, IsReadFromOneSettingAndRefusesUnknownWords) {
  const auto load = [](const std::string& setting) {
    return LoadConfig<PicturesConfig>("", {setting});
  };
  const PicturesConfig config =
      load("cameras=[{name: front}, {name: wrist, at: hand, width: 64}, {name: s, at: scene}]");
  ASSERT_EQ(config.cameras.size(), 3U);
  EXPECT_EQ(config.cameras[1].at, CameraPlace::kHand);
  EXPECT_EQ(config.cameras[1].width, 64);
  EXPECT_EQ(RefusalOf([&] { CheckPictures(config); }), "accepted");
  ExpectNames(RefusalOf([&] { load("streams=[depht]"); }), "depth");
  ExpectNames(RefusalOf([&] { load("cameras=[{nmae: front}]"); }), "name");
  ExpectNames(RefusalOf([&] { load("cameras=[{name: a, at: ceiling}]"); }), "hand");
}

TEST(PicturesConfig, RefusesNamesSizesAndViewsThatGiveNoPicture) {
  for (const char* name : {"", "a b", "a.b", "../x"})
    ExpectNames(RefusalOf(Named(name, CameraPlace::kWorld)), "name");
  PicturesConfig twice = WithCamera(Named("a", CameraPlace::kWorld));
  twice.cameras.push_back(twice.cameras[0]);
  ExpectNames(RefusalOf([&] { CheckPictures(twice); }), "two are called \"a\"");

  for (const int size : {0, -1, kMostPicturePixels + 1}) {
    PictureCamera camera = Named("a", CameraPlace::kWorld);
    camera.height = size;
    ExpectNames(RefusalOf(camera), "height " + std::to_string(size));
  }
  PictureCamera blind = Named("a", CameraPlace::kWorld);
  blind.target_m = {1.8, 0, 1.8};
  ExpectNames(RefusalOf(blind), "same point");
  blind.target_m = {1.8, 0, 0};
  ExpectNames(RefusalOf(blind), "up");
  blind.target_m = {1.8, 0};
  ExpectNames(RefusalOf(blind), "2 numbers");
  blind = Named("a", CameraPlace::kWorld);
  blind.horizontal_fov_rad = 0;
  ExpectNames(RefusalOf(blind), "horizontal_fov_rad");
  PictureCamera scene = Named("a", CameraPlace::kScene);
  scene.width = 64;
  ExpectNames(RefusalOf(scene), "config.scene.camera");

  PicturesConfig nothing = WithCamera(Named("a", CameraPlace::kWorld));
  nothing.streams.clear();
  ExpectNames(RefusalOf([&] { CheckPictures(nothing); }), "streams");
}

TEST(PicturesConfig, RefusesACameraInsideTheLeafTheWallOrTheHand) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  Eigen::AlignedBox3d leaf;
  for (const Eigen::Vector3d& vertex : door.links[kLeafLink].geometry[0].mesh.vertices)
    leaf.extend(scene.world_from_door * DoorFromLinks(door, 0, 0)[kLeafLink] * vertex);
  PictureCamera camera = Named("front", CameraPlace::kWorld);
  camera.position_m = {leaf.center().x(), leaf.center().y(), leaf.center().z()};
  ExpectNames(RefusalOf([&] { CheckPictures(WithCamera(camera), scene, door); }),
              "\"front\": at (");
  camera.position_m[0] = leaf.max().x() + 0.3;
  EXPECT_EQ(RefusalOf([&] { CheckPictures(WithCamera(camera), scene, door); }), "accepted");

  camera.position_m = {leaf.center().x(), leaf.max().y() + 1, leaf.center().z()};
  ExpectNames(RefusalOf([&] { CheckPictures(WithCamera(camera), scene, door); }), "the wall");

  const RobotModel robot = LoadMobileFranka();
  PictureCamera wrist = Named("wrist", CameraPlace::kHand);
  EXPECT_EQ(RefusalOf([&] { CheckPictures(WithCamera(wrist), robot); }), "accepted");
  wrist.position_m = {0, 0, 0.03};
  ExpectNames(RefusalOf([&] { CheckPictures(WithCamera(wrist), robot); }), "of the robot");
}

TEST(PicturesConfig, BytesAreThoseOfTheArrays) {
  PicturesConfig config;
  EXPECT_EQ(PictureBytes(config, {}, 70), 0);
  config.cameras = {Named("a", CameraPlace::kWorld), Named("s", CameraPlace::kScene)};
  config.cameras[0].width = 10;
  config.cameras[0].height = 20;
  config.streams = {PictureStream::kDepth, PictureStream::kNormal};
  CameraModel scene;
  scene.width = scene.height = 100;
  EXPECT_EQ(PictureBytes(config, scene, 70), 5 * (200 + 10000));
  config.cloud_rgb = true;
  EXPECT_EQ(PictureBytes(config, scene, 70), 5 * (200 + 10000) + 3 * 70);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How pictures in the data look and what they cost: a sheet of the doors in the folders given, one
// row a door, as each appearance shows them, and the processor's time of a 256 x 256 picture, with
// AVX-512 as well where the processor has it.
//
//     picture_sheet SHEET.png DOOR...

#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/pictures/take_pictures.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {
namespace {

constexpr int kSide = 256;
constexpr int kLooks = 10;  // for the time

double ProcessorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

PicturesConfig Cameras(const std::vector<PictureStream>& streams, bool with_wrist) {
  PicturesConfig config;
  config.cameras.resize(with_wrist ? 2 : 1);
  config.cameras[0].name = "front";
  if (with_wrist) {
    config.cameras[1].name = "wrist";
    config.cameras[1].at = CameraPlace::kHand;
  }
  config.streams = streams;
  return config;
}

PictureLook LookAt(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                   double hinge_rad) {
  PictureLook look;
  look.snapshot.robot = robot.PoseAt(StartPosition(scene, robot), scene.world_from_robot_base);
  look.snapshot.door = DoorFromLinks(door, hinge_rad, 0);
  for (RigidTransform& pose : look.snapshot.door) pose = scene.world_from_door * pose;
  return look;
}

Picture PictureOf(const MemberBytes& member) {
  Picture picture;
  picture.width = picture.height = kSide;
  const std::size_t count = std::size_t{3} * kSide * kSide;
  picture.rgb.assign(member.bytes.end() - static_cast<std::ptrdiff_t>(count), member.bytes.end());
  return picture;
}

// Milliseconds of a picture, of several in turn.
double Milliseconds(const PictureScene& scene, const PicturesConfig& config,
                    const PictureLook& look) {
  const std::vector<PictureLook> looks(kLooks, look);
  const auto time = [&](std::size_t count) {
    const double begin = ProcessorSeconds();
    TakePictures(scene, config, std::span(looks).first(count));
    return ProcessorSeconds() - begin;
  };
  time(1);
  const double one = time(1);  // with the setting up
  return 1000 * (time(kLooks) - one) / (kLooks - 1);
}

void PrintTimes(const std::string& what, const PictureScene& scene, const PictureLook& look) {
  PicturesConfig rgb = Cameras({PictureStream::kRgb}, false);
  const PicturesConfig others = Cameras({PictureStream::kDepth, PictureStream::kLabel}, false);
  std::printf("%-68s rgb %6.1f ms, depth and labels %6.1f ms", what.c_str(),
              Milliseconds(scene, rgb, look), Milliseconds(scene, others, look));
  if (IsSupported(RayIsa::kAvx512)) {
    rgb.instructions = PictureInstructions::kAvx512;
    std::printf(", rgb with AVX-512 %6.1f ms", Milliseconds(scene, rgb, look));
  }
  std::printf("\n");
}

void Run(int argc, char** argv) {
  const RobotModel robot = LoadMobileFranka();
  std::vector<Picture> pictures;
  std::vector<std::string> captions;
  for (int i = 2; i < argc; ++i) {
    const DoorAsset door = ReadDoor(argv[i]);
    for (const auto& [appearance, name] : kSceneAppearances) {
      const int draws = appearance == SceneAppearance::kFull ? 2 : 1;
      for (int draw = 0; draw < draws; ++draw) {
        Scene scene =
            PlaceRobotBase(robot, SampleScene(door, 1, static_cast<std::uint64_t>(draw)), door);
        scene.appearance = appearance;
        const PictureLook look = LookAt(scene, door, robot, 0.5 * draw);
        const PictureScene seen{scene, door, robot, true, scene.camera};
        const bool wrist = appearance == SceneAppearance::kOff;
        for (const MemberBytes& member :
             TakePictures(seen, Cameras({PictureStream::kRgb}, wrist), std::span(&look, 1))
                 .members) {
          if (!member.name.starts_with("rgb_")) continue;
          pictures.push_back(PictureOf(member));
          captions.push_back(door.id + " " + std::string(name));
        }
        if (draw == 0) PrintTimes(door.id + ' ' + std::string(name), seen, look);
      }
    }
  }
  WritePng(argv[1], ContactSheet(pictures, captions,
                                 {.columns = 5, .tile_width = kSide, .tile_height = kSide}));
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: picture_sheet SHEET.png DOOR...\n");
    return 2;
  }
  try {
    doorforge::Run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "picture_sheet: %s\n", error.what());
    return 3;
  }
  return 0;
}

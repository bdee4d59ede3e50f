// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/scene_sampling.h"

#include <algorithm>
#include <numbers>

#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

struct Range {
  double low;
  double high;
};

// Where UniDoorManip puts the grasp point of a closed door and the robot's base, in the world.
struct Placement {
  Range grasp_x;
  Range grasp_y;
  Range grasp_z;
  Eigen::Vector2d base;
  Eigen::Vector2d jitter;  ///< Along x and y.
};

Placement PlacementOf(Category category) {
  switch (category) {
    case Category::kInterior:
      return {{0.04, 0.12}, {0.16, 0.40}, {0.90, 1.11}, {0.70, 0}, {0.10, 0.15}};
    case Category::kWindow:
      return {{0.04, 0.13}, {0.21, 0.44}, {0.74, 1.04}, {0.65, 0}, {0.10, 0.10}};
    case Category::kCar:
      return {{0.02, 0.05}, {0.07, 0.09}, {0.80, 0.98}, {0.60, -0.10}, {0.10, 0.10}};
    case Category::kSafe:
      return {{0.02, 0.13}, {0, 0}, {0.83, 1.06}, {0.77, 0}, {0.08, 0.08}};
    case Category::kStorageFurniture:
      return {{0.03, 0.08}, {0, 0}, {0.74, 0.96}, {0.70, 0}, {0.10, 0.15}};
    case Category::kRefrigerator:
      return {{0.06, 0.11}, {-0.06, -0.04}, {0.84, 1.02}, {0.70, 0}, {0.10, 0.15}};
  }
  return {};
}

constexpr double kLeastHeight = 0.1;
constexpr double kBaseHeight = 0.1;

double ClippedNormal(Rng& rng) { return std::clamp(0.5 * rng.Normal(), -1.0, 1.0); }

double ShiftInto(const Range& range, double value) {
  return std::clamp(value, range.low, range.high) - value;
}

RigidTransform PlaceDoor(const DoorAsset& door, const Placement& placement) {
  const RigidTransform door_from_grasp =
      DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp;
  const Eigen::Vector3d grasp = door_from_grasp.translation();
  const double lift = kLeastHeight + ShiftInto(placement.grasp_z, grasp.z() + kLeastHeight);
  return Translation({ShiftInto(placement.grasp_x, grasp.x()),
                      ShiftInto(placement.grasp_y, grasp.y()), std::max(lift, kLeastHeight)});
}

RigidTransform PlaceRobot(const Placement& placement, double jitter, Rng rng) {
  const double x = placement.base.x() + jitter * placement.jitter.x() * ClippedNormal(rng);
  const double y = placement.base.y() + jitter * placement.jitter.y() * ClippedNormal(rng);
  return Translation({x, y, kBaseHeight}) *
         RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi);
}

RigidTransform GraspNoise(const DoorAsset& door, double scale, Rng rng) {
  const double turn = scale * ClippedNormal(rng) * std::numbers::pi / 18;
  const bool along = door.mechanism == Mechanism::kLever || door.mechanism == Mechanism::kFlap;
  const double shift = along ? scale * ClippedNormal(rng) * door.grasp_half_extent_m.x() : 0;
  return Translation({shift, 0, 0}) * RotationAbout(Eigen::Vector3d::UnitZ(), turn);
}

}  // namespace

Scene SampleScene(const DoorAsset& door, std::uint64_t seed, std::uint64_t episode,
                  const SceneConfig& config) {
  RequireSimulatable(door, "scene");
  const std::string stream = "scene/" + door.id + "/" + std::to_string(episode) + "/";
  const Placement placement = PlacementOf(door.category);
  Scene scene;
  scene.door_id = door.id;
  scene.door_sha256 = ContentHash(door);
  scene.seed = seed;
  scene.episode = episode;
  scene.world_from_door = PlaceDoor(door, placement);
  scene.world_from_robot_base =
      PlaceRobot(placement, config.base_jitter, Rng(seed, stream + "base"));
  scene.latch = door.latch;
  scene.grasp_from_noisy_grasp = GraspNoise(door, config.grasp_noise, Rng(seed, stream + "grasp"));
  scene.physics = config.physics;
  return scene;
}

}  // namespace doorforge

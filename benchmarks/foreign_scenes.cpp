// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "foreign_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

#include "doorforge/schemas/cloud.h"

namespace doorforge::benchmark {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr auto kRobot = static_cast<std::uint8_t>(PointLabel::kRobot);
constexpr auto kHandle = static_cast<std::uint8_t>(PointLabel::kHandle);
constexpr auto kOther = static_cast<std::uint8_t>(PointLabel::kOther);

/// Depth along a ray whose direction is 1 m along the optical axis.
using Scenery = std::function<float(const Eigen::Vector3d& from, const Eigen::Vector3d& along)>;

struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

double DepthOf(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double a = (box.low[k] - from[k]) / along[k];
    const double b = (box.high[k] - from[k]) / along[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near < far ? near : std::numeric_limits<double>::infinity();
}

Scenery Boxes(std::vector<Box> boxes) {
  return [boxes = std::move(boxes)](const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Box& box : boxes) nearest = std::min(nearest, DepthOf(box, from, along));
    return static_cast<float>(nearest);
  };
}

// Across the whole view, `x_m` out of the door's plane.
Scenery WallAt(double x_m) { return Boxes({{{x_m - 1, -50, -50}, {x_m, 50, 50}}}); }

// A floor, a wall, and four boxes where the door would be.
Scenery Room(Rng& rng) {
  const double wall_x = rng.Uniform(-0.8, -0.3);
  std::vector<Box> boxes = {{{wall_x - 1, -2, -0.1}, {wall_x, 2, 3}}, {{-3, -3, -0.1}, {4, 3, 0}}};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d foot(rng.Uniform(-0.2, 0.5), rng.Uniform(-1, 1), 0);
    const Eigen::Vector3d half(rng.Uniform(0.1, 0.35), rng.Uniform(0.1, 0.45), 0);
    boxes.push_back({foot - half, foot + half + Eigen::Vector3d::UnitZ() * rng.Uniform(0.3, 1.4)});
  }
  return Boxes(std::move(boxes));
}

/// Makes kinds of one picture.
class Maker {
 public:
  Maker(const DepthImage& sound, const PinholeView& view) : sound_(sound), view_(view) {
    Add("sound");
  }

  Shot& Add(std::string kind) { return shots_.emplace_back(Shot{std::move(kind), sound_, view_}); }

  void AddScenery(const std::string& kind, const Scenery& scenery, bool with_robot) {
    Shot& shot = Add(kind + (with_robot ? ", robot" : ""));
    const RigidTransform& pose = view_.world_from_camera;
    for (int row = 0; row < sound_.height; ++row) {
      for (int column = 0; column < sound_.width; ++column) {
        const Eigen::Vector3d along((column + 0.5 - view_.cx) / view_.fx,
                                    (row + 0.5 - view_.cy) / view_.fy, 1);
        const auto i = static_cast<std::size_t>(row * sound_.width + column);
        float depth = scenery(pose.translation(), pose.linear() * along);
        if (with_robot && sound_.label[i] == kRobot) depth = std::min(depth, sound_.depth_m[i]);
        shot.depth.depth_m[i] = depth;
      }
    }
  }

  template <class Change>
  void AddChanged(const std::string& kind, const Change& change) {
    for (float& depth : Add(kind).depth.depth_m) depth = static_cast<float>(change(depth));
  }

  void AddUpsideDown() {
    Shot& shot = Add("upside down");
    std::ranges::reverse(shot.depth.depth_m);
    std::ranges::reverse(shot.depth.label);
  }

  void AddMaskAbove(int pixels) {
    Shot& shot = Add("mask above the handle");
    std::ranges::fill(shot.depth.label, kOther);
    const auto up = static_cast<std::size_t>(pixels * sound_.width);
    for (std::size_t i = up; i < sound_.label.size(); ++i)
      if (sound_.label[i] == kHandle) shot.depth.label[i - up] = kHandle;
  }

  std::vector<Shot> Take() { return std::move(shots_); }

 private:
  const DepthImage& sound_;
  const PinholeView& view_;
  std::vector<Shot> shots_;
};

void AddSceneries(Maker& make, bool with_robot, Rng& rng) {
  make.AddScenery("wall in the door's plane", WallAt(0), with_robot);
  make.AddScenery("wall 0.3 m behind it", WallAt(-0.3), with_robot);
  make.AddScenery("room without a door", Room(rng), with_robot);
}

void AddWithoutRobot(Maker& make, Rng& rng) {
  for (const double distance_m : {0.6, 1.0, 1.5, 2.0}) {
    char kind[40];
    std::snprintf(kind, sizeof kind, "wall %.1f m ahead", distance_m);
    make.AddChanged(kind, [&](float) { return distance_m; });
  }
  AddSceneries(make, false, rng);
  make.AddChanged("all zeros", [](float) { return kNothing; });
  make.AddChanged("all far", [](float) { return 9.0; });
  make.AddChanged("noise alone", [&](float) { return rng.Uniform(0.3, 2.5); });
  make.AddChanged("noise of 5 %", [&](float depth) {
    return static_cast<double>(depth) * (1 + 0.05 * rng.Normal());
  });
  make.AddUpsideDown();
}

void AddWrongCameras(Maker& make) {
  make.Add("camera file: 0.2 m aside").view.world_from_camera.translation().y() += 0.2;
  make.Add("camera file: 0.2 m lower").view.world_from_camera.translation().z() -= 0.2;
  PinholeView& turned = make.Add("camera file: turned 20 deg").view;
  turned.world_from_camera.linear() =
      Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitZ()) * turned.world_from_camera.linear();
  PinholeView& wide = make.Add("camera file: 0.6 focal length").view;
  wide.fx *= 0.6;
  wide.fy *= 0.6;
  make.AddChanged("camera file: half the unit", [](float depth) { return depth / 2; });
}

}  // namespace

std::vector<Shot> ForeignShots(const DepthImage& sound, const PinholeView& view, Rng& rng) {
  Maker make(sound, view);
  AddWithoutRobot(make, rng);
  AddSceneries(make, true, rng);
  AddWrongCameras(make);
  return make.Take();
}

std::vector<Shot> ForeignLooks(const DepthImage& sound, const PinholeView& view, Rng& rng) {
  Maker make(sound, view);
  AddWithoutRobot(make, rng);
  AddWrongCameras(make);
  make.AddMaskAbove(sound.height / 13);
  return make.Take();
}

}  // namespace doorforge::benchmark

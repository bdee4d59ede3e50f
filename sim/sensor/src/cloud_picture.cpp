// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/sensor/scene_picture.h"

#include "canvas.h"

namespace doorforge {
namespace {

constexpr double kPointRadius = 0.0065;  // [m]

constexpr std::array<std::string_view, kPointLabelCount> kLabelNames = {"body", "handle", "frame",
                                                                        "robot", "other"};

struct Disc {
  double depth;
  Eigen::Vector2d center;  // [pixels]
  double radius;           // likewise
  std::uint8_t label;
};

std::vector<Disc> Project(const LabelledCloud& cloud, const CameraModel& camera) {
  const RigidTransform camera_from_world = WorldFromCamera(camera).inverse();
  const Eigen::Matrix3d intrinsics = IntrinsicMatrix(camera);
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    const Eigen::Vector3d point(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]);
    const Eigen::Vector3d in_camera = camera_from_world * point;
    if (in_camera.z() < 0.05) continue;
    const Eigen::Vector3d pixel = intrinsics * in_camera / in_camera.z();
    const double radius = std::max(1.4, intrinsics(0, 0) * kPointRadius / in_camera.z());
    discs.push_back({in_camera.z(), pixel.head<2>(), radius, cloud.label[i]});
  }
  std::stable_sort(discs.begin(), discs.end(),
                   [](const Disc& a, const Disc& b) { return a.depth > b.depth; });
  return discs;
}

internal::Color Bytes(const Eigen::Vector3d& rgb) {
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(255 * value));
  };
  return {byte(rgb.x()), byte(rgb.y()), byte(rgb.z())};
}

PointLabel LabelOf(std::uint8_t value) {
  return value < kPointLabelCount ? static_cast<PointLabel>(value) : PointLabel::kOther;
}

void DrawLegend(internal::Canvas& canvas, const LabelledCloud& cloud) {
  std::array<int, kPointLabelCount> counts{};
  for (const std::uint8_t label : cloud.label)
    ++counts.at(static_cast<std::size_t>(LabelOf(label)));
  const double scale = std::clamp(canvas.picture().width / 960.0, 0.35, 1.2);
  const int step = static_cast<int>(std::lround(26 * scale));
  int y = step;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    canvas.Disc(Eigen::Vector2d(step * 2 / 3, y), step / 4,
                Bytes(ColorOf(static_cast<PointLabel>(i))));
    const std::string text = std::string(kLabelNames[i]) + "  " + std::to_string(counts[i]);
    canvas.Text(text, Eigen::Vector2d(step * 5 / 4, y + step / 4), 11 * scale, {70, 70, 70});
    y += step;
  }
}

}  // namespace

Eigen::Vector3d ColorOf(PointLabel label) {
  // Okabe and Ito's palette, which the colour-blind can tell apart
  switch (label) {
    case PointLabel::kBody:
      return {0.00, 0.45, 0.70};
    case PointLabel::kHandle:
      return {0.90, 0.49, 0.00};
    case PointLabel::kFrame:
      return {0.55, 0.58, 0.62};
    case PointLabel::kRobot:
      return {0.00, 0.62, 0.45};
    case PointLabel::kOther:
      break;
  }
  return {0.80, 0.47, 0.65};
}

Picture CloudPicture(const LabelledCloud& cloud, const CameraModel& camera) {
  const bool valid = camera.width > 0 && camera.height > 0 && camera.width <= 8192 &&
                     camera.height <= 8192 && cloud.xyz.size() == 3 * cloud.label.size();
  Require(valid, ErrorCode::kInvalidArgument,
          "cloud picture: image size out of range, or a label is missing");
  internal::Canvas canvas(camera.width, camera.height, {255, 255, 255});
  const std::vector<Disc> discs = Project(cloud, camera);
  const double near = discs.empty() ? 0 : discs.back().depth;
  const double range = discs.empty() ? 1 : std::max(discs.front().depth - near, 1e-6);
  for (const Disc& disc : discs) {
    // farther points fade a little, which gives depth to the picture
    const double fade = 0.45 * (disc.depth - near) / range;
    const Eigen::Vector3d rgb =
        ColorOf(LabelOf(disc.label)) * (1 - fade) + Eigen::Vector3d::Ones() * fade;
    canvas.Disc(disc.center, disc.radius, Bytes(rgb));
  }
  DrawLegend(canvas, cloud);
  return std::move(canvas).Take();
}

}  // namespace doorforge

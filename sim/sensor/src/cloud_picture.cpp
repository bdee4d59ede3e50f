// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <opencv2/imgproc.hpp>

#include "doorforge/core/error.h"
#include "doorforge/sensor/scene_picture.h"

#include "picture_mat.h"

namespace doorforge {
namespace {

constexpr double kPointRadius = 0.0065;  // [m]
constexpr int kFractionBits = 4;         // of positions within a pixel

constexpr std::array<std::string_view, kPointLabelCount> kLabelNames = {"body", "handle", "frame",
                                                                        "robot", "other"};

struct Disc {
  double depth;
  cv::Point center;  // in 1/16 pixel
  int radius;        // likewise
  std::uint8_t label;
};

std::vector<Disc> Project(const LabelledCloud& cloud, const CameraModel& camera) {
  const RigidTransform camera_from_world = WorldFromCamera(camera).inverse();
  const Eigen::Matrix3d intrinsics = IntrinsicMatrix(camera);
  const double unit = 1 << kFractionBits;
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    const Eigen::Vector3d point(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]);
    const Eigen::Vector3d in_camera = camera_from_world * point;
    if (in_camera.z() < 0.05) continue;
    const Eigen::Vector3d pixel = intrinsics * in_camera / in_camera.z();
    // OpenCV's pixel centres lie on whole numbers
    const cv::Point center(static_cast<int>(std::lround((pixel.x() - 0.5) * unit)),
                           static_cast<int>(std::lround((pixel.y() - 0.5) * unit)));
    const double radius = std::max(1.4, intrinsics(0, 0) * kPointRadius / in_camera.z());
    discs.push_back(
        {in_camera.z(), center, static_cast<int>(std::lround(radius * unit)), cloud.label[i]});
  }
  std::stable_sort(discs.begin(), discs.end(),
                   [](const Disc& a, const Disc& b) { return a.depth > b.depth; });
  return discs;
}

cv::Scalar Bgr(const Eigen::Vector3d& rgb) { return {255 * rgb.z(), 255 * rgb.y(), 255 * rgb.x()}; }

PointLabel LabelOf(std::uint8_t value) {
  return value < kPointLabelCount ? static_cast<PointLabel>(value) : PointLabel::kOther;
}

void DrawLegend(cv::Mat& mat, const LabelledCloud& cloud) {
  std::array<int, kPointLabelCount> counts{};
  for (const std::uint8_t label : cloud.label)
    ++counts.at(static_cast<std::size_t>(LabelOf(label)));
  const double scale = std::clamp(mat.cols / 960.0, 0.35, 1.2);
  const int step = static_cast<int>(std::lround(26 * scale));
  int y = step;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    cv::circle(mat, {step * 2 / 3, y}, step / 4, Bgr(ColorOf(static_cast<PointLabel>(i))),
               cv::FILLED, cv::LINE_AA);
    const std::string text = std::string(kLabelNames[i]) + "  " + std::to_string(counts[i]);
    cv::putText(mat, text, {step * 5 / 4, y + step / 4}, cv::FONT_HERSHEY_SIMPLEX, 0.55 * scale,
                cv::Scalar(70, 70, 70), 1, cv::LINE_AA);
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
  cv::Mat mat(camera.height, camera.width, CV_8UC3, cv::Scalar(255, 255, 255));
  const std::vector<Disc> discs = Project(cloud, camera);
  const double near = discs.empty() ? 0 : discs.back().depth;
  const double range = discs.empty() ? 1 : std::max(discs.front().depth - near, 1e-6);
  for (const Disc& disc : discs) {
    // farther points fade a little, which gives depth to the picture
    const double fade = 0.45 * (disc.depth - near) / range;
    const Eigen::Vector3d rgb =
        ColorOf(LabelOf(disc.label)) * (1 - fade) + Eigen::Vector3d::Ones() * fade;
    cv::circle(mat, disc.center, disc.radius, Bgr(rgb), cv::FILLED, cv::LINE_AA, kFractionBits);
  }
  DrawLegend(mat, cloud);
  return FromMat(mat);
}

}  // namespace doorforge

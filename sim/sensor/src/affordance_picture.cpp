// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/affordance_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "doorforge/core/error.h"
#include "doorforge/sensor/scene_picture.h"

#include "picture_mat.h"
#include "pixel_rays.h"

namespace doorforge {
namespace {

constexpr int kSamples = 2;          // a pixel, each way, of the coloured part
constexpr double kSurround = 0.085;  // shown around the map, where the hand is drawn [m]
constexpr double kAside = 0.45;  // a hand that points away from the camera would be a line [rad]

// the hand as lines, metres in the frame between the pads
constexpr double kOpening = 0.04;
constexpr double kFinger = 0.045;
constexpr double kWrist = 0.1;

const cv::Scalar kRed(46, 46, 214);  // blue, green, red
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kInk(60, 60, 60);

Eigen::Vector3d PointOf(const AffordanceMap& map, std::size_t i) {
  return Eigen::Vector3f(map.point_xyz[3 * i], map.point_xyz[3 * i + 1], map.point_xyz[3 * i + 2])
      .cast<double>();
}

void RequireValid(const AffordanceMap& map) {
  const auto finite = [](float number) { return std::isfinite(number); };
  const bool valid = !map.affordance_rad.empty() &&
                     map.point_xyz.size() == 3 * map.affordance_rad.size() &&
                     std::all_of(map.point_xyz.begin(), map.point_xyz.end(), finite) &&
                     std::all_of(map.affordance_rad.begin(), map.affordance_rad.end(), finite) &&
                     map.contact_m.allFinite() && map.world_from_tcp.matrix().allFinite();
  Require(valid, ErrorCode::kInvalidArgument,
          "affordance picture: the map is empty, its sizes disagree or a number is not finite");
}

// Least and greatest value.
struct Range {
  float low;
  float high;
};

Range RangeOf(const AffordanceMap& map) {
  const auto [low, high] =
      std::minmax_element(map.affordance_rad.begin(), map.affordance_rad.end());
  return {*low, *high};
}

// Mean of the three nearest points, weighted by the inverse of the squared distance.
double ValueAt(const AffordanceMap& map, const Eigen::Vector3d& place) {
  struct Near {
    double squared = std::numeric_limits<double>::infinity();
    float value = 0;
  };
  std::array<Near, 3> nearest;
  for (std::size_t i = 0; i < map.affordance_rad.size(); ++i) {
    Near found{(PointOf(map, i) - place).squaredNorm(), map.affordance_rad[i]};
    for (Near& known : nearest) {
      if (found.squared < known.squared) std::swap(found, known);
    }
  }
  double sum = 0;
  double weights = 0;
  for (const Near& point : nearest) {
    const double weight = 1 / (point.squared + 1e-8);
    sum += weight * static_cast<double>(point.value);
    weights += weight;
  }
  return sum / weights;
}

// 256 colours of viridis, dark to bright.
cv::Mat Palette() {
  cv::Mat steps(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) steps.at<std::uint8_t>(i) = static_cast<std::uint8_t>(i);
  cv::Mat colors;
  cv::applyColorMap(steps, colors, cv::COLORMAP_VIRIDIS);
  return colors;
}

// Grey and a little paler, so that the colours stand out.
cv::Mat Greyed(const cv::Mat& shaded) {
  cv::Mat grey;
  cv::cvtColor(shaded, grey, cv::COLOR_BGR2GRAY);
  grey = 0.75 * grey + 64;
  cv::Mat result;
  cv::cvtColor(grey, result, cv::COLOR_GRAY2BGR);
  return result;
}

// The handle's colours over the grey picture; a pixel is the mean of its samples.
class Colouring {
 public:
  Colouring(const AffordanceMap& map, const DepthImage& samples, const CameraModel& camera)
      : map_(map), samples_(samples), rays_(camera), range_(RangeOf(map)), palette_(Palette()) {}

  void Paint(cv::Mat& picture) const {
    for (int row = 0; row < picture.rows; ++row) {
      for (int column = 0; column < picture.cols; ++column)
        PaintPixel(picture.at<cv::Vec3b>(row, column), column, row);
    }
  }

 private:
  void PaintPixel(cv::Vec3b& pixel, int column, int row) const {
    cv::Vec3d sum(0, 0, 0);
    const double light = pixel[0];  // grey: all three are equal
    for (int dy = 0; dy < kSamples; ++dy) {
      for (int dx = 0; dx < kSamples; ++dx)
        sum += ColorOf(kSamples * column + dx, kSamples * row + dy, light);
    }
    pixel = sum / (kSamples * kSamples);
  }

  // A sample has the map's colour with a trace of the shading, or the grey of what is no handle.
  cv::Vec3d ColorOf(int column, int row, double light) const {
    const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(samples_.width) +
                   static_cast<std::size_t>(column);
    if (samples_.label[i] != static_cast<std::uint8_t>(PointLabel::kHandle))
      return {light, light, light};
    const Eigen::Vector3d place =
        rays_.origin() + static_cast<double>(samples_.depth_m[i]) *
                             rays_.Direction(column + 0.5, row + 0.5).cast<double>();
    const double range = std::max(1e-6, static_cast<double>(range_.high - range_.low));
    const double share = (ValueAt(map_, place) - static_cast<double>(range_.low)) / range;
    const int index = static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    return (0.72 + 0.36 * light / 255) * cv::Vec3d(palette_.at<cv::Vec3b>(index));
  }

  const AffordanceMap& map_;
  const DepthImage& samples_;
  PixelRays rays_;
  Range range_;
  cv::Mat palette_;
};

// The hand and the contact, drawn over the picture.
class HandDrawing {
 public:
  HandDrawing(cv::Mat& picture, const CameraModel& camera)
      : picture_(picture),
        camera_from_world_(WorldFromCamera(camera).inverse()),
        intrinsics_(IntrinsicMatrix(camera)) {}

  void Draw(const AffordanceMap& map) {
    const auto at = [&](double y, double z) {
      return PixelOf(map.world_from_tcp * Eigen::Vector3d(0, y, z));
    };
    for (const bool outline : {true, false}) {
      const cv::Scalar& color = outline ? kWhite : kRed;
      const int width = outline ? 5 : 2;
      cv::line(picture_, at(0, -kWrist), at(0, -kFinger), color, width, cv::LINE_AA);
      cv::line(picture_, at(-kOpening, -kFinger), at(kOpening, -kFinger), color, width,
               cv::LINE_AA);
      for (const double side : {-1.0, 1.0}) {
        cv::line(picture_, at(side * kOpening, -kFinger), at(side * kOpening, 0), color, width,
                 cv::LINE_AA);
        cv::arrowedLine(picture_, at(side * kOpening, 0), at(side * 0.2 * kOpening, 0), color,
                        width, cv::LINE_AA, 0, 0.35);
      }
    }
    const cv::Point contact = PixelOf(map.contact_m);
    cv::circle(picture_, contact, 5, kInk, 4, cv::LINE_AA);
    cv::circle(picture_, contact, 5, kWhite, 2, cv::LINE_AA);
  }

 private:
  cv::Point PixelOf(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d in_camera = camera_from_world_ * place;
    const Eigen::Vector3d pixel = intrinsics_ * in_camera / std::max(in_camera.z(), 1e-3);
    return {static_cast<int>(std::lround(std::clamp(pixel.x() - 0.5, -1e4, 1e4))),
            static_cast<int>(std::lround(std::clamp(pixel.y() - 0.5, -1e4, 1e4)))};
  }

  cv::Mat& picture_;
  RigidTransform camera_from_world_;
  Eigen::Matrix3d intrinsics_;
};

std::string DegreesText(float angle_rad) {
  return std::to_string(std::lround(static_cast<double>(angle_rad) * 180 / std::numbers::pi)) +
         " deg";
}

// A strip below the picture.
cv::Mat WithScale(const cv::Mat& picture, Range range) {
  constexpr int kStrip = 28;
  constexpr double kFont = 0.45;
  cv::Mat result;
  cv::copyMakeBorder(picture, result, 0, kStrip, 0, 0, cv::BORDER_CONSTANT, kWhite);
  const auto width = [](const std::string& text) {
    return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFont, 1, nullptr).width;
  };
  const auto write = [&](const std::string& text, int left) {
    cv::putText(result, text, {left, picture.rows + 19}, cv::FONT_HERSHEY_SIMPLEX, kFont, kInk, 1,
                cv::LINE_AA);
  };
  const std::string low = DegreesText(range.low);
  const std::string high = DegreesText(range.high);
  const int left = width(low) + 16;
  const int right = picture.cols - width(high) - 16;
  write(low, 8);
  write(high, right + 8);
  if (right - left < 8) return result;  // too narrow a picture for a bar
  cv::Mat bar = result(cv::Rect(left, picture.rows + 8, right - left, 12));
  cv::resize(Palette(), bar, bar.size(), 0, 0, cv::INTER_LINEAR);
  return result;
}

}  // namespace

CameraModel CameraOn(const AffordanceMap& map, const CameraModel& camera) {
  RequireValid(map);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < map.affordance_rad.size(); ++i) box.extend(PointOf(map, i));
  CameraModel close = camera;
  close.target_m = box.center();
  close.position_m =
      close.target_m + RotationAbout(camera.up, kAside) * (camera.position_m - close.target_m);
  const double distance = std::max(0.1, (close.target_m - close.position_m).norm());
  const double half = box.diagonal().norm() / 2 + kSurround;
  const double wide = std::max(1.0, static_cast<double>(camera.width) / camera.height);
  close.horizontal_fov_rad = 2 * std::atan(half * wide / distance);
  return close;
}

Picture AffordancePicture(DepthCamera& camera, std::span<const RigidTransform> world_from_link,
                          const CameraModel& view, const AffordanceMap& map) {
  RequireValid(map);
  CameraModel fine = view;
  fine.width *= kSamples;
  fine.height *= kSamples;
  const DepthImage samples = camera.Render(fine, world_from_link);
  cv::Mat picture = Greyed(ToMat(RenderPicture(camera.scene(), view)));
  Colouring(map, samples, fine).Paint(picture);
  HandDrawing(picture, view).Draw(map);
  return FromMat(WithScale(picture, RangeOf(map)));
}

}  // namespace doorforge

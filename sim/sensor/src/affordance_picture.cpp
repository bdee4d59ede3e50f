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

#include "doorforge/core/error.h"
#include "doorforge/sensor/scene_picture.h"

#include "canvas.h"
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

constexpr internal::Color kHandRed = {214, 46, 46};
constexpr internal::Color kHandOutline = {255, 255, 255};
constexpr internal::Color kScaleInk = {60, 60, 60};

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

// Grey and a little paler, so that the colours stand out.
Picture Greyed(Picture picture) {
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    const double luma =
        0.299 * picture.rgb[i] + 0.587 * picture.rgb[i + 1] + 0.114 * picture.rgb[i + 2];
    const auto pale = static_cast<std::uint8_t>(std::lround(0.75 * luma + 64));
    std::fill_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3, pale);
  }
  return picture;
}

// The handle's colours over the grey picture; a pixel is the mean of its samples.
class Colouring {
 public:
  Colouring(const AffordanceMap& map, const DepthImage& samples, const CameraModel& camera)
      : map_(map), samples_(samples), rays_(camera), range_(RangeOf(map)) {}

  void Paint(Picture& picture) const {
    std::uint8_t* pixel = picture.rgb.data();
    for (int row = 0; row < picture.height; ++row) {
      for (int column = 0; column < picture.width; ++column, pixel += 3)
        PaintPixel(pixel, column, row);
    }
  }

 private:
  void PaintPixel(std::uint8_t* pixel, int column, int row) const {
    Eigen::Vector3d sum(0, 0, 0);
    const double light = pixel[0];  // grey: all three are equal
    for (int dy = 0; dy < kSamples; ++dy) {
      for (int dx = 0; dx < kSamples; ++dx)
        sum += ColorOf(kSamples * column + dx, kSamples * row + dy, light);
    }
    for (int c = 0; c < 3; ++c)
      pixel[c] =
          static_cast<std::uint8_t>(std::lround(std::min(sum[c] / (kSamples * kSamples), 255.0)));
  }

  // A sample has the map's colour with a trace of the shading, or the grey of what is no handle.
  Eigen::Vector3d ColorOf(int column, int row, double light) const {
    const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(samples_.width) +
                   static_cast<std::size_t>(column);
    if (samples_.label[i] != static_cast<std::uint8_t>(PointLabel::kHandle))
      return {light, light, light};
    const Eigen::Vector3d place =
        rays_.origin() + static_cast<double>(samples_.depth_m[i]) *
                             rays_.Direction(column + 0.5, row + 0.5).cast<double>();
    const double range = std::max(1e-6, static_cast<double>(range_.high - range_.low));
    const double share = (ValueAt(map_, place) - static_cast<double>(range_.low)) / range;
    const internal::Color color = internal::Viridis(share);
    return (0.72 + 0.36 * light / 255) * Eigen::Vector3d(color[0], color[1], color[2]);
  }

  const AffordanceMap& map_;
  const DepthImage& samples_;
  PixelRays rays_;
  Range range_;
};

// The hand and the contact, drawn over the picture.
class HandDrawing {
 public:
  HandDrawing(internal::Canvas& picture, const CameraModel& camera)
      : picture_(picture),
        camera_from_world_(WorldFromCamera(camera).inverse()),
        intrinsics_(IntrinsicMatrix(camera)) {}

  void Draw(const AffordanceMap& map) {
    const auto at = [&](double y, double z) {
      return PixelOf(map.world_from_tcp * Eigen::Vector3d(0, y, z));
    };
    for (const bool outline : {true, false}) {
      color_ = outline ? kHandOutline : kHandRed;
      width_ = outline ? 5 : 2;
      Line(at(0, -kWrist), at(0, -kFinger));
      Line(at(-kOpening, -kFinger), at(kOpening, -kFinger));
      for (const double side : {-1.0, 1.0}) {
        Line(at(side * kOpening, -kFinger), at(side * kOpening, 0));
        Arrow(at(side * kOpening, 0), at(side * 0.2 * kOpening, 0));
      }
    }
    const Eigen::Vector2d contact = PixelOf(map.contact_m);
    picture_.Ring(contact, 5, 4, kScaleInk);
    picture_.Ring(contact, 5, 2, kHandOutline);
  }

 private:
  void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    picture_.Line(from, to, width_, color_);
  }

  void Arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    Line(from, to);
    for (const double turn : {-1.0, 1.0})
      Line(to, to + Eigen::Rotation2Dd(turn * std::numbers::pi / 4) * (0.35 * (from - to)));
  }

  Eigen::Vector2d PixelOf(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d in_camera = camera_from_world_ * place;
    const Eigen::Vector3d pixel = intrinsics_ * in_camera / std::max(in_camera.z(), 1e-3);
    return pixel.head<2>().cwiseMax(-1e4).cwiseMin(1e4);
  }

  internal::Canvas& picture_;
  RigidTransform camera_from_world_;
  Eigen::Matrix3d intrinsics_;
  internal::Color color_{};
  double width_ = 0;
};

std::string DegreesText(float angle_rad) {
  return std::to_string(std::lround(static_cast<double>(angle_rad) * 180 / std::numbers::pi)) +
         " deg";
}

// A strip below the picture.
Picture WithScale(const Picture& picture, Range range) {
  constexpr int kStrip = 28;
  constexpr double kCapital = 9;
  internal::Canvas result(picture.width, picture.height + kStrip, kHandOutline);
  result.Paste(picture, 0, 0);
  const auto width = [](const std::string& text) {
    return static_cast<int>(std::ceil(internal::TextWidth(text, kCapital)));
  };
  const auto write = [&](const std::string& text, int left) {
    result.Text(text, Eigen::Vector2d(left, picture.height + 19), kCapital, kScaleInk);
  };
  const std::string low = DegreesText(range.low);
  const std::string high = DegreesText(range.high);
  const int left = width(low) + 16;
  const int right = picture.width - width(high) - 16;
  write(low, 8);
  write(high, right + 8);
  if (right - left < 8) return std::move(result).Take();  // too narrow a picture for a bar
  Picture bar{right - left, 12, {}};
  for (int row = 0; row < bar.height; ++row) {
    for (int column = 0; column < bar.width; ++column) {
      const internal::Color color = internal::Viridis((column + 0.5) / bar.width);
      bar.rgb.insert(bar.rgb.end(), color.begin(), color.end());
    }
  }
  result.Paste(bar, left, picture.height + 8);
  return std::move(result).Take();
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
  Picture picture = Greyed(RenderPicture(camera.scene(), view));
  Colouring(map, samples, fine).Paint(picture);
  internal::Canvas canvas(std::move(picture));
  HandDrawing(canvas, view).Draw(map);
  return WithScale(canvas.picture(), RangeOf(map));
}

}  // namespace doorforge

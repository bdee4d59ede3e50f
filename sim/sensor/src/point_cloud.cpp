// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "doorforge/core/error.h"
#include "doorforge/sensor/farthest_point_sampling.h"

#include "pixel_rays.h"

namespace doorforge {
namespace {

int NearestPoint(const std::vector<float>& xyz, const Eigen::Vector3d& target) {
  int nearest = 0;
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i * 3 < xyz.size(); ++i) {
    const Eigen::Vector3d point(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    const double squared = (point - target).squaredNorm();
    if (squared >= nearest_squared) continue;
    nearest_squared = squared;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

void AppendPoint(const LabelledCloud& from, std::size_t index, LabelledCloud& to) {
  to.xyz.insert(to.xyz.end(), from.xyz.begin() + static_cast<std::ptrdiff_t>(3 * index),
                from.xyz.begin() + static_cast<std::ptrdiff_t>(3 * index + 3));
  to.label.push_back(from.label[index]);
  if (from.rgb.empty()) return;
  to.rgb.insert(to.rgb.end(), from.rgb.begin() + static_cast<std::ptrdiff_t>(3 * index),
                from.rgb.begin() + static_cast<std::ptrdiff_t>(3 * index + 3));
}

// The points near point `centre`, in their order.
LabelledCloud PointsWithin(const LabelledCloud& cloud, std::size_t centre, double crop_radius_m) {
  LabelledCloud near;
  const Eigen::Map<const Eigen::Vector3f> middle(&cloud.xyz[3 * centre]);
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> point(&cloud.xyz[3 * i]);
    if (static_cast<double>((point - middle).norm()) <= crop_radius_m) AppendPoint(cloud, i, near);
  }
  return near;
}

void RequireSameSize(const DepthImage& image, int width, int height) {
  Require(image.width == width && image.height == height, ErrorCode::kInvalidArgument,
          "point cloud: image and camera differ in size");
}

std::size_t IndexOf(const DepthImage& image, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
         static_cast<std::size_t>(column);
}

// The pixels inside the crop, where `point_at` puts them. What is compared with NaN is left out.
template <class PointAt>
LabelledCloud Cropped(const DepthImage& image, const CloudConfig& config, const PointAt& point_at) {
  Require(image.rgb.empty() || image.rgb.size() == 3 * image.depth_m.size(),
          ErrorCode::kInvalidArgument, "point cloud: depth and colours differ in size");
  LabelledCloud cloud;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const std::size_t pixel = IndexOf(image, column, row);
      const double depth = image.depth_m[pixel];
      if (!(depth > 0 && depth < config.max_depth_m)) continue;
      const Eigen::Vector3d point = point_at(column, row, depth);
      if (!(point.z() > config.min_height_m)) continue;
      for (const double coordinate : point) cloud.xyz.push_back(static_cast<float>(coordinate));
      cloud.label.push_back(image.label[pixel]);
      if (image.rgb.empty()) continue;
      const std::uint8_t* rgb = &image.rgb[3 * pixel];
      cloud.rgb.insert(cloud.rgb.end(), rgb, rgb + 3);
    }
  }
  return cloud;
}

}  // namespace

PinholeView ViewOf(const CameraModel& camera) {
  const Eigen::Matrix3d intrinsics = IntrinsicMatrix(camera);
  return {camera.width,     camera.height,    intrinsics(0, 0),       intrinsics(1, 1),
          intrinsics(0, 2), intrinsics(1, 2), WorldFromCamera(camera)};
}

LabelledCloud CropCloud(const DepthImage& image, const CameraModel& camera,
                        const CloudConfig& config) {
  return CropCloud(image, ViewOf(camera), config);
}

LabelledCloud CropCloud(const DepthImage& image, const PinholeView& view,
                        const CloudConfig& config) {
  RequireSameSize(image, view.width, view.height);
  const PixelRays rays(view);
  return Cropped(image, config, [&](int column, int row, double depth_m) {
    return rays.PointAt(column + 0.5, row + 0.5, depth_m);
  });
}

LabelledCloud CropCloud(const DepthImage& image, const RigidTransform& world_from_camera,
                        const PixelDirections& directions, const CloudConfig& config) {
  RequireSameSize(image, directions.width, directions.height);
  return Cropped(image, config, [&](int column, int row, double depth_m) -> Eigen::Vector3d {
    const Eigen::Vector2d& ideal = directions.ideal[IndexOf(image, column, row)];
    return world_from_camera * Eigen::Vector3d(depth_m * ideal.homogeneous());
  });
}

std::optional<std::size_t> PixelOfPoint(const DepthImage& image, const PinholeView& view,
                                        const Eigen::Vector3f& point) {
  RequireSameSize(image, view.width, view.height);
  const Eigen::Vector3d in_camera = view.world_from_camera.inverse() * point.cast<double>();
  if (!(in_camera.z() > 0)) return {};
  const double column = std::floor(view.fx * in_camera.x() / in_camera.z() + view.cx);
  const double row = std::floor(view.fy * in_camera.y() / in_camera.z() + view.cy);
  if (!(column >= 0 && row >= 0 && column < image.width && row < image.height)) return {};
  const std::size_t pixel = IndexOf(image, static_cast<int>(column), static_cast<int>(row));
  const Eigen::Vector3d there =
      PixelRays(view).PointAt(column + 0.5, row + 0.5, image.depth_m[pixel]);
  if (there.cast<float>() != point) return {};
  return pixel;
}

SampledCloud SampleCloud(const LabelledCloud& visible, const Eigen::Vector3d& start_m,
                         const CloudExtent& extent) {
  Require(extent.point_count >= 1 && extent.point_count <= 1000000, ErrorCode::kInvalidArgument,
          "point cloud: point_count out of 1..1000000");
  Require(extent.crop_radius_m >= 0 && std::isfinite(extent.crop_radius_m),
          ErrorCode::kInvalidArgument, "point cloud: within_m must be at least 0");
  Require(start_m.allFinite(), ErrorCode::kInvalidArgument,
          "point cloud: the start position is not finite");
  if (extent.crop_radius_m > 0 && !visible.label.empty()) {
    const auto nearest = static_cast<std::size_t>(NearestPoint(visible.xyz, start_m));
    return SampleCloud(PointsWithin(visible, nearest, extent.crop_radius_m), start_m,
                       {extent.point_count});
  }
  SampledCloud result;
  result.visible_count = static_cast<int>(visible.label.size());
  if (result.visible_count == 0) return result;
  const std::vector<std::int32_t> order =
      FarthestPoints(visible.xyz, std::min(extent.point_count, result.visible_count),
                     NearestPoint(visible.xyz, start_m));
  const std::size_t count = static_cast<std::size_t>(extent.point_count);
  result.cloud.xyz.reserve(3 * count);
  result.cloud.label.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    AppendPoint(visible, static_cast<std::size_t>(order[i % order.size()]), result.cloud);
  return result;
}

SampledCloud ObserveCloud(const DepthImage& image, const CameraModel& camera,
                          const Eigen::Vector3d& start_m, const CloudConfig& config) {
  return SampleCloud(CropCloud(image, camera, config), start_m, {config.point_count});
}

}  // namespace doorforge

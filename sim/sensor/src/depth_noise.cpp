// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

#include "pixel_rays.h"

namespace doorforge {
namespace {

constexpr float kNoDepth = std::numeric_limits<float>::infinity();
constexpr float kFar = 1e6F;  // stands for no depth where depths are compared

// Handa, Whelan, McDonald and Davison, "A Benchmark for RGB-D Visual Odometry, 3D Reconstruction
// and SLAM", ICRA 2014, section III: a Kinect's disparity in eighths of a pixel at 1 m, its spread,
// and the spread of the pixel that the depth comes from.
constexpr double kDisparityAtOneMetre = 351.3;
constexpr double kDisparitySpread = 1.0 / 6;
constexpr double kJitterPixels = 0.5;

// time of flight: spread = kFloor + kGrowth * depth^2
constexpr double kTimeOfFlightFloorM = 0.0004;
constexpr double kTimeOfFlightGrowthPerM = 0.0003;
constexpr double kTimeOfFlightStepM = 0.001;

// What this is of a pixel and its neighbours, one way after the other; those beyond the border do
// not count.
template <class Choose>
std::vector<float> OfNeighbours(const std::vector<float>& depth, int width, Choose&& choose) {
  const auto across = static_cast<std::size_t>(width);
  std::vector<float> row(depth);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (i % across > 0) row[i] = choose(row[i], depth[i - 1]);
    if (i % across + 1 < across) row[i] = choose(row[i], depth[i + 1]);
  }
  std::vector<float> all(row);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (i >= across) all[i] = choose(all[i], row[i - across]);
    if (i + across < depth.size()) all[i] = choose(all[i], row[i + across]);
  }
  return all;
}

struct SensedRange {
  std::vector<float> low;
  std::vector<float> high;
};

// least and largest depth among 3 x 3 pixels
SensedRange NeighbourRange(const DepthImage& image) {
  std::vector<float> depth(image.depth_m);
  for (float& metres : depth) metres = std::min(metres, kFar);
  return {OfNeighbours(depth, image.width, [](float a, float b) { return std::min(a, b); }),
          OfNeighbours(depth, image.width, [](float a, float b) { return std::max(a, b); })};
}

// What chance decides at one pixel, for whatever kind of sensor.
struct PixelDraws {
  double mixed = 0;   // uniform in 0..1
  double across = 0;  // these three are normal with spread 1
  double down = 0;
  double along = 0;
};

class NoisySensor {
 public:
  NoisySensor(const DepthImage& ideal, const CameraModel& camera, const DepthNoiseConfig& config)
      : ideal_(ideal), rays_(camera), config_(config), range_(NeighbourRange(ideal)) {}

  // infinity where the sensor gives none
  float DepthOf(int row, int column, Rng& rng) const {
    // as many draws for every pixel, so that one pixel's fate does not change the others'
    const double dropped = rng.Uniform();
    PixelDraws draws;
    draws.mixed = rng.Uniform();
    draws.across = rng.Normal();
    draws.down = rng.Normal();
    draws.along = rng.Normal();
    if (std::isinf(At(row, column)) || IsGrazing(row, column)) return kNoDepth;
    const bool edge =
        range_.high[PixelAt(row, column)] - range_.low[PixelAt(row, column)] >= config_.edge_step_m;
    if (edge && dropped < config_.edge_dropout) return kNoDepth;
    switch (config_.sensor) {
      case DepthSensor::kStructuredLight:
        return StructuredLight(row, column, draws);
      case DepthSensor::kTimeOfFlight:
        return TimeOfFlight(edge ? FlyingDepth(row, column, draws.mixed) : At(row, column),
                            draws.along);
      case DepthSensor::kNone:
        break;
    }
    return At(row, column);
  }

 private:
  std::size_t PixelAt(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(ideal_.width) +
           static_cast<std::size_t>(column);
  }

  float At(int row, int column) const { return ideal_.depth_m[PixelAt(row, column)]; }

  Eigen::Vector3d PointAt(int row, int column) const {
    return At(row, column) * rays_.Direction(column + 0.5, row + 0.5).cast<double>();
  }

  // the surface by the differences to the next pixels of the same link
  bool IsGrazing(int row, int column) const {
    const int next_row = row + 1 < ideal_.height ? row + 1 : row - 1;
    const int next_column = column + 1 < ideal_.width ? column + 1 : column - 1;
    if (next_row < 0 || next_column < 0) return false;
    if (!SameLink(row, column, next_row, column) || !SameLink(row, column, row, next_column))
      return false;
    const Eigen::Vector3d point = PointAt(row, column);
    const Eigen::Vector3d normal =
        (PointAt(next_row, column) - point).cross(PointAt(row, next_column) - point).normalized();
    return std::fabs(normal.dot(point.normalized())) < std::cos(config_.grazing_rad);
  }

  bool SameLink(int row, int column, int other_row, int other_column) const {
    const auto link = [&](int r, int c) { return ideal_.link[PixelAt(r, c)]; };
    return link(row, column) == link(other_row, other_column);
  }

  float StructuredLight(int row, int column, const PixelDraws& draws) const {
    const double jitter = kJitterPixels * config_.scale;
    const auto moved = [&](int place, double by, int count) {
      return std::clamp(place + static_cast<int>(std::lround(jitter * by)), 0, count - 1);
    };
    const float depth =
        At(moved(row, draws.down, ideal_.height), moved(column, draws.across, ideal_.width));
    if (std::isinf(depth)) return kNoDepth;
    const double disparity = std::floor(kDisparityAtOneMetre / depth +
                                        config_.scale * kDisparitySpread * draws.along + 0.5);
    return disparity > 0 ? static_cast<float>(kDisparityAtOneMetre / disparity) : kNoDepth;
  }

  // light of both sides of an edge reaches one pixel
  float FlyingDepth(int row, int column, double share) const {
    const float low = range_.low[PixelAt(row, column)];
    const float high = range_.high[PixelAt(row, column)];
    if (high >= kFar) return At(row, column);  // nothing comes back from the open side
    const double near_share = std::min(1.0, config_.scale * share);
    const double depth = At(row, column);
    const double other = depth - low < high - depth ? high : low;
    return static_cast<float>(depth + 0.5 * near_share * (other - depth));
  }

  float TimeOfFlight(float depth, double draw) const {
    const double spread = kTimeOfFlightFloorM + kTimeOfFlightGrowthPerM * depth * depth;
    const double measured = depth + config_.scale * spread * draw;
    const double steps = std::round(measured / kTimeOfFlightStepM);
    return steps > 0 ? static_cast<float>(steps * kTimeOfFlightStepM) : kNoDepth;
  }

  const DepthImage& ideal_;
  PixelRays rays_;
  const DepthNoiseConfig& config_;
  SensedRange range_;
};

void RequireWithin(double value, double high, const char* name) {
  if (std::isfinite(value) && value >= 0 && value <= high) return;
  throw Error(ErrorCode::kInvalidConfig, std::string("config.cloud.noise.") + name + ": found " +
                                             std::to_string(value) + ", allowed 0 to " +
                                             std::to_string(high));
}

}  // namespace

void CheckDepthNoise(const DepthNoiseConfig& config) {
  RequireWithin(config.scale, 100, "scale");
  RequireWithin(config.edge_dropout, 1, "edge_dropout");
  RequireWithin(config.edge_step_m, 10, "edge_step_m");
  RequireWithin(config.grazing_rad, std::numbers::pi / 2, "grazing_rad");
  RequireWithin(config.extrinsic_m, 1, "extrinsic_m");
  RequireWithin(config.extrinsic_rad, 1, "extrinsic_rad");
}

DepthImage WithDepthNoise(const DepthImage& ideal, const CameraModel& camera,
                          const DepthNoiseConfig& config, Rng rng) {
  CheckDepthNoise(config);
  Require(ideal.width == camera.width && ideal.height == camera.height, ErrorCode::kInvalidArgument,
          "depth noise: image and camera differ in size");
  if (config.sensor == DepthSensor::kNone) return ideal;
  const NoisySensor sensor(ideal, camera, config);
  DepthImage noisy = ideal;
  std::size_t pixel = 0;
  for (int row = 0; row < ideal.height; ++row) {
    for (int column = 0; column < ideal.width; ++column, ++pixel) {
      noisy.depth_m[pixel] = sensor.DepthOf(row, column, rng);
      if (std::isfinite(noisy.depth_m[pixel])) continue;
      noisy.link[pixel] = -1;
      noisy.label[pixel] = static_cast<std::uint8_t>(PointLabel::kOther);
    }
  }
  return noisy;
}

CameraModel CameraWithCalibrationError(const CameraModel& camera, const DepthNoiseConfig& config,
                                       Rng rng) {
  CheckDepthNoise(config);
  if (config.sensor == DepthSensor::kNone || (config.extrinsic_m == 0 && config.extrinsic_rad == 0))
    return camera;
  const auto draw = [&](double spread) {
    const double x = rng.Normal();
    const double y = rng.Normal();
    return Eigen::Vector3d(spread * Eigen::Vector3d(x, y, rng.Normal()));
  };
  const Eigen::Vector3d turn = draw(config.extrinsic_rad);
  const Eigen::Matrix3d rotation =
      turn.norm() == 0 ? Eigen::Matrix3d::Identity()
                       : Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  CameraModel believed = camera;
  believed.position_m += draw(config.extrinsic_m);
  believed.target_m = believed.position_m + rotation * (camera.target_m - camera.position_m);
  believed.up = rotation * camera.up;
  return believed;
}

}  // namespace doorforge

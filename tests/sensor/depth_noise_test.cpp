// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/depth_noise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "shapes.h"

namespace doorforge {
namespace {

const std::vector<RigidTransform> kStillWall(2, RigidTransform::Identity());

// looks along -x at a wall that fills the picture
CameraModel Facing(double distance) {
  CameraModel camera;
  camera.position_m = {distance, 0, 1.5};
  camera.target_m = {0, 0, 1.5};
  return camera;
}

DepthImage WallAt(double distance) {
  return DepthCamera({{shapes::Wall(0, 9), 0, PointLabel::kBody}})
      .Render(Facing(distance), kStillWall);
}

struct Spread {
  double mean = 0;
  double deviation = 0;
  double missing = 0;  // share of pixels
};

Spread SpreadOf(const DepthImage& image) {
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const float depth : image.depth_m) {
    if (std::isinf(depth)) continue;
    sum += depth;
    squares += static_cast<double>(depth) * depth;
    ++count;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean),
          1 - count / static_cast<double>(image.depth_m.size())};
}

DepthImage Noisy(const DepthImage& ideal, double distance, const DepthNoiseConfig& config,
                 std::uint64_t seed = 1) {
  return WithDepthNoise(ideal, Facing(distance), config, Rng(seed, "noise"));
}

// Depths of whole disparities around `disparity`, which was disturbed by N(0, 1/6).
Spread RoundedDisparities(double disparity) {
  const auto below = [&](double limit) {
    return 0.5 * std::erfc(-(limit - disparity) * 6 / std::sqrt(2.0));
  };
  double mean = 0;
  double squares = 0;
  for (double whole = std::floor(disparity) - 3; whole < disparity + 4; ++whole) {
    const double share = below(whole + 0.5) - below(whole - 0.5);
    mean += share * 351.3 / whole;
    squares += share * std::pow(351.3 / whole, 2);
  }
  return {mean, std::sqrt(squares - mean * mean)};
}

TEST(DepthNoise, NoSensorMeansNoNoise) {
  const DepthImage ideal = WallAt(1.5);
  EXPECT_EQ(Noisy(ideal, 1.5, {}).depth_m, ideal.depth_m);
}

TEST(DepthNoise, StructuredLightRoundsANoisyDisparity) {
  const DepthNoiseConfig config{.sensor = DepthSensor::kStructuredLight};
  for (const double distance : {0.8, 1.5, 2.4}) {
    const Spread spread = SpreadOf(Noisy(WallAt(distance), distance, config));
    const Spread expected = RoundedDisparities(351.3 / distance);
    EXPECT_NEAR(spread.deviation, expected.deviation, 0.02 * expected.deviation) << distance;
    EXPECT_NEAR(spread.mean, expected.mean, 1e-4) << distance;
    EXPECT_EQ(spread.missing, 0);
  }
}

TEST(DepthNoise, StructuredLightMeasuresWholeDisparities) {
  const DepthImage noisy = Noisy(WallAt(1.5), 1.5, {.sensor = DepthSensor::kStructuredLight});
  for (const float depth : noisy.depth_m) {
    const double disparity = 351.3 / depth;
    ASSERT_NEAR(disparity, std::round(disparity), 1e-4);
  }
}

TEST(DepthNoise, TimeOfFlightSpreadsAboutAMillimetreAndIsUnbiased) {
  const Spread spread = SpreadOf(Noisy(WallAt(1.5), 1.5, {.sensor = DepthSensor::kTimeOfFlight}));
  const double noise = 0.0004 + 0.0003 * 1.5 * 1.5;
  EXPECT_NEAR(spread.deviation, std::sqrt(noise * noise + 1e-6 / 12), 5e-5);
  EXPECT_NEAR(spread.mean, 1.5, 5e-5);  // 65,536 pixels
  EXPECT_EQ(spread.missing, 0);
}

TEST(DepthNoise, EdgesLoseTheShareOfPixelsThatWasAskedFor) {
  // a board 0.2 m before the wall: its outline is four edges two pixels wide
  const DepthImage ideal = DepthCamera({{shapes::Wall(0, 9), 0, PointLabel::kBody},
                                        {shapes::Wall(0.2, 0.5), 1, PointLabel::kHandle}})
                               .Render(Facing(1.5), kStillWall);
  const auto missing = [&](double dropout) {
    DepthNoiseConfig config{.sensor = DepthSensor::kTimeOfFlight};
    config.edge_dropout = dropout;
    const DepthImage noisy = Noisy(ideal, 1.5, config);
    for (std::size_t i = 0; i < noisy.depth_m.size(); ++i)
      EXPECT_EQ(std::isinf(noisy.depth_m[i]), noisy.link[i] == -1);
    return SpreadOf(noisy).missing;
  };
  const double all = missing(1);
  const double side_px = 1.0 / 1.3 * 128;  // of the board, at 128 pixels a tangent
  EXPECT_NEAR(all * 256 * 256, 4 * side_px * 2, 60);
  EXPECT_NEAR(missing(0.4), 0.4 * all, 0.1 * all);
  EXPECT_EQ(missing(0), 0);
}

TEST(DepthNoise, FlyingPixelsLieBetweenTheTwoSidesOfAnEdge) {
  const DepthImage ideal = DepthCamera({{shapes::Wall(0, 9), 0, PointLabel::kBody},
                                        {shapes::Wall(0.2, 0.5), 1, PointLabel::kHandle}})
                               .Render(Facing(1.5), kStillWall);
  DepthNoiseConfig config{.sensor = DepthSensor::kTimeOfFlight};
  config.edge_dropout = 0;
  int flying = 0;
  for (const float depth : Noisy(ideal, 1.5, config).depth_m) {
    EXPECT_GT(depth, 1.29F);
    EXPECT_LT(depth, 1.51F);
    flying += depth > 1.32F && depth < 1.48F ? 1 : 0;
  }
  EXPECT_GT(flying, 200);
  EXPECT_LT(flying, 800);
}

TEST(DepthNoise, SurfacesAlongTheRaysAreNotSeen) {
  TriangleMesh floor;  // 0.1 m below the camera
  floor.vertices = {{-9, -9, 1.4}, {9, -9, 1.4}, {9, 9, 1.4}, {-9, 9, 1.4}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  const CameraModel camera = Facing(1.5);
  const DepthImage ideal = DepthCamera({{floor, 0, PointLabel::kBody}}).Render(camera, kStillWall);
  DepthNoiseConfig config{.sensor = DepthSensor::kTimeOfFlight};
  config.edge_step_m = 10;  // rows of the floor are far apart in depth
  const DepthImage noisy = WithDepthNoise(ideal, camera, config, Rng(1, "noise"));
  const int center = 128;
  for (int row = 129; row < 256; ++row) {
    const double below = (row + 0.5 - 128) / 128;  // tangent of the ray's angle below the horizon
    const double grazing = std::acos(below / std::sqrt(1 + below * below));
    if (std::fabs(grazing - config.grazing_rad) < 0.02) continue;
    EXPECT_EQ(std::isinf(noisy.depth_m[static_cast<std::size_t>(row * 256 + center)]),
              grazing > config.grazing_rad)
        << row;
  }
}

TEST(DepthNoise, CalibrationErrorsHaveTheSpreadThatWasAskedFor) {
  DepthNoiseConfig config{.sensor = DepthSensor::kTimeOfFlight};
  config.extrinsic_m = 0.01;
  config.extrinsic_rad = 0.02;
  const CameraModel camera = Facing(1.5);
  double shift = 0;
  double turn = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    const CameraModel believed =
        CameraWithCalibrationError(camera, config, Rng(7, std::to_string(i)));
    shift += (believed.position_m - camera.position_m).squaredNorm();
    const Eigen::Matrix3d between =
        WorldFromCamera(camera).linear().transpose() * WorldFromCamera(believed).linear();
    turn += std::pow(Eigen::AngleAxisd(between).angle(), 2);
  }
  EXPECT_NEAR(std::sqrt(shift / kDraws), 0.01 * std::sqrt(3), 5e-4);
  EXPECT_NEAR(std::sqrt(turn / kDraws), 0.02 * std::sqrt(3), 1e-3);
  EXPECT_EQ(CameraWithCalibrationError(camera, {}, Rng(7, "")).position_m, camera.position_m);
}

TEST(DepthNoise, RefusesWhatIsOutOfRange) {
  const auto refused = [](auto&& change) {
    DepthNoiseConfig config{.sensor = DepthSensor::kTimeOfFlight};
    change(config);
    EXPECT_THROW(CheckDepthNoise(config), Error);
  };
  refused([](auto& c) { c.edge_dropout = 1.1; });
  refused([](auto& c) { c.scale = -1; });
  refused([](auto& c) { c.extrinsic_m = std::nan(""); });
}

}  // namespace
}  // namespace doorforge

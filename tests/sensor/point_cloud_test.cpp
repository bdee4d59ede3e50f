// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "shapes.h"

namespace doorforge {
namespace {

const std::vector<RigidTransform> kStillScene(4, RigidTransform::Identity());

LabelledCloud Line(int count) {
  LabelledCloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.xyz.insert(cloud.xyz.end(), {static_cast<float>(i), 0.0F, 1.0F});
    cloud.label.push_back(static_cast<std::uint8_t>(i % kPointLabelCount));
  }
  return cloud;
}

using Point = std::tuple<float, float, float, int>;
std::vector<Point> PointsOf(const LabelledCloud& cloud) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < cloud.label.size(); ++i)
    points.emplace_back(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2],
                        cloud.label[i]);
  return points;
}

TEST(CropCloud, PutsPointsBackOntoTheSurfaceTheyCameFrom) {
  DepthCamera camera({{shapes::Wall(0.0, 0.4), 0, PointLabel::kBody}});
  const CameraModel model;
  const LabelledCloud cloud = CropCloud(camera.Render(model, kStillScene), model);
  ASSERT_GT(cloud.label.size(), 2000U);
  double lowest_z = 9;
  double highest_y = -9;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    EXPECT_NEAR(cloud.xyz[3 * i], 0, 1e-6);
    EXPECT_LE(std::fabs(cloud.xyz[3 * i + 1]), 0.4 + 1e-6);
    highest_y = std::max<double>(highest_y, cloud.xyz[3 * i + 1]);
    lowest_z = std::min<double>(lowest_z, cloud.xyz[3 * i + 2]);
  }
  EXPECT_NEAR(highest_y, 0.4, 0.02);
  EXPECT_NEAR(lowest_z, 1.1, 0.02);
}

TEST(PixelOfPoint, IsThePixelThatThePointWasMadeOf) {
  DepthCamera camera({{shapes::Wall(0.0, 0.4), 0, PointLabel::kBody}});
  CameraModel model;
  model.position_m = {1.7, 0.4, 1.6};
  const DepthImage image = camera.Render(model, kStillScene);
  const PinholeView view = ViewOf(model);
  const LabelledCloud cloud = CropCloud(image, view);
  ASSERT_GT(cloud.label.size(), 2000U);
  std::size_t last = 0;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    const Eigen::Vector3f point(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]);
    const auto pixel = PixelOfPoint(image, view, point);
    ASSERT_TRUE(pixel.has_value()) << i;
    if (i > 0) {
      EXPECT_GT(*pixel, last);  // clouds are in the order of pixels
    }
    last = *pixel;
    EXPECT_LT(image.depth_m[*pixel], 2.5F);
    Eigen::Vector3f beside = point;
    beside.y() = std::nextafter(beside.y(), 9.0F);
    EXPECT_FALSE(PixelOfPoint(image, view, beside).has_value());
  }
  EXPECT_FALSE(PixelOfPoint(image, view, {5, 0, 1}).has_value());        // behind the camera
  EXPECT_FALSE(PixelOfPoint(image, view, {0, 50, 1}).has_value());       // beside the image
  EXPECT_FALSE(PixelOfPoint(image, view, {1, 0.2F, 1.4F}).has_value());  // before the wall
}

TEST(CropCloud, DropsWhatIsFarOrLow) {
  DepthCamera camera({{shapes::Wall(0, 3), 0, PointLabel::kBody}});
  const CameraModel model;
  const DepthImage image = camera.Render(model, kStillScene);
  const Eigen::Vector3d forward = WorldFromCamera(model).linear().col(2);
  const LabelledCloud cloud = CropCloud(image, model);
  double deepest = 0;
  double lowest = 9;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    const Eigen::Vector3d point(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]);
    deepest = std::max(deepest, forward.dot(point - model.position_m));
    lowest = std::min(lowest, point.z());
  }
  EXPECT_LT(deepest, 2.5 + 1e-6);
  EXPECT_GT(lowest, 0.1);
  EXPECT_LT(lowest, 0.15);
  EXPECT_LT(CropCloud(image, model, {.max_depth_m = 1.8}).label.size(), cloud.label.size());
  EXPECT_EQ(CropCloud(image, model, {.min_height_m = 9}).label.size(), 0U);
}

// A driver says 0, NaN or infinity of a pixel that it could not measure.
TEST(CropCloud, MakesNoPointOfAHole) {
  DepthCamera camera({{shapes::Wall(0, 3), 0, PointLabel::kBody}});
  const CameraModel model;
  DepthImage image = camera.Render(model, kStillScene);
  const std::size_t before = CropCloud(image, model).label.size();
  const std::size_t middle = image.depth_m.size() / 2 + 128;
  for (const float hole : {0.0F, -0.5F, std::nanf(""), HUGE_VALF}) {
    ASSERT_LT(image.depth_m[middle], 2.5F);
    DepthImage holed = image;
    holed.depth_m[middle] = hole;
    EXPECT_EQ(CropCloud(holed, model).label.size(), before - 1) << hole;
  }
}

TEST(CropCloud, RefusesAnImageOfAnotherCamera) {
  DepthCamera camera({});
  const CameraModel model;
  CameraModel other;
  other.width = 128;
  EXPECT_THROW(CropCloud(camera.Render(model, kStillScene), other), Error);
}

TEST(ObserveCloud, GivesExactly4096VisiblePointsStartingAtTheGripper) {
  DepthCamera camera({{shapes::Box({-0.05, -0.5, 0}, {0, 0.5, 2}), 0, PointLabel::kBody},
                      {shapes::Box({0.5, 0.1, 0.9}, {0.6, 0.2, 1.1}), 1, PointLabel::kRobot}});
  const CameraModel model;
  const DepthImage image = camera.Render(model, kStillScene);
  const LabelledCloud visible = CropCloud(image, model);
  const Eigen::Vector3d gripper(0.55, 0.15, 1.2);
  const SampledCloud sampled = ObserveCloud(image, model, gripper);
  ASSERT_EQ(sampled.cloud.label.size(), 4096U);
  ASSERT_EQ(sampled.cloud.xyz.size(), 3 * 4096U);
  EXPECT_EQ(sampled.visible_count, static_cast<int>(visible.label.size()));
  EXPECT_EQ(sampled.cloud.label[0], 3);

  const std::vector<Point> all = PointsOf(visible);
  const std::vector<Point> chosen = PointsOf(sampled.cloud);
  const std::set<Point> known(all.begin(), all.end());
  EXPECT_TRUE(std::all_of(chosen.begin(), chosen.end(),
                          [&](const Point& point) { return known.count(point) == 1; }));
  EXPECT_EQ(std::set<Point>(chosen.begin(), chosen.end()).size(), 4096U);
}

TEST(SampleCloud, RepeatsTheSequenceWhereFewerPointsAreVisible) {
  const SampledCloud sampled = SampleCloud(Line(5), {3.1, 0, 1}, {12});
  ASSERT_EQ(sampled.cloud.label.size(), 12U);
  EXPECT_EQ(sampled.visible_count, 5);
  const std::vector<Point> points = PointsOf(sampled.cloud);
  // from 3: farthest is 0, then 1 (of 1, 2, 4, all at 1 from the nearest taken: lowest index), ...
  const std::vector<float> order = {3, 0, 1, 2, 4};
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(std::get<0>(points[i]), order[i % 5]) << i;
}

TEST(SampleCloud, GivesNoPointsWhereNothingIsVisible) {
  const SampledCloud sampled = SampleCloud({}, {0, 0, 0}, {4096});
  EXPECT_EQ(sampled.visible_count, 0);
  EXPECT_TRUE(sampled.cloud.xyz.empty());
  EXPECT_TRUE(sampled.cloud.label.empty());
}

TEST(SampleCloud, KeepsEachLabelWithItsPoint) {
  for (const auto& [x, y, z, label] : PointsOf(SampleCloud(Line(50), {0, 0, 0}, {50}).cloud))
    EXPECT_EQ(label, static_cast<int>(x) % kPointLabelCount);
}

TEST(SampleCloud, SpendsItsPointsOnWhatIsWithinTheExtentOfPointZero) {
  // the visible point nearest to the start is 10, not the start itself
  const SampledCloud sampled = SampleCloud(Line(50), {10.4, 0, 1}, {8, 3.2});
  EXPECT_EQ(sampled.visible_count, 7);
  std::vector<float> x;
  for (const auto& point : PointsOf(sampled.cloud)) x.push_back(std::get<0>(point));
  EXPECT_EQ(x.front(), 10);
  EXPECT_EQ(x.back(), 10) << "seven points, then the sequence again";
  EXPECT_EQ(std::set<float>(x.begin(), x.end()), (std::set<float>{7, 8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(SampleCloud(Line(50), {10.4, 0, 1}, {8, 1000}).cloud.xyz,
            SampleCloud(Line(50), {10.4, 0, 1}, {8}).cloud.xyz);
  EXPECT_TRUE(SampleCloud({}, {0, 0, 0}, {8, 1}).cloud.xyz.empty());
}

TEST(SampleCloud, RefusesCountsAndStartsOutOfRange) {
  EXPECT_THROW(SampleCloud(Line(5), {0, 0, 0}, {0}), Error);
  EXPECT_THROW(SampleCloud(Line(5), {0, 0, 0}, {1000001}), Error);
  EXPECT_THROW(SampleCloud(Line(5), {0, NAN, 0}, {5}), Error);
  EXPECT_THROW(SampleCloud(Line(5), {0, 0, 0}, {5, -1}), Error);
  EXPECT_THROW(SampleCloud(Line(5), {0, 0, 0}, {5, NAN}), Error);
}

}  // namespace
}  // namespace doorforge

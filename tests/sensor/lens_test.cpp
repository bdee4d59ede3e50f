// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/lens.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {
namespace {

struct Known {
  LensDistortion lens;
  std::array<Eigen::Vector2d, 4> seen;  // of kIdeal
};

const std::array<Eigen::Vector2d, 4> kIdeal = {
    {{0.3, -0.2}, {-0.62, 0.41}, {0.05, 0.01}, {0.7, 0.55}}};

// projectPoints() and fisheye::projectPoints() of OpenCV 4.11.0 gave what is seen.
const std::array<Known, 4> kKnown = {{
    {{LensModel::kPolynomial, {-0.28, 0.09, 0.0012, -0.0008, -0.012}},
     {{{0.2891363908, -0.1926709272},
       {-0.54153163240875, 0.358480337560625},
       {0.0499587504094544, 0.00999528608189088},
       {0.57956257329375, 0.456819736159375}}}},
    {{LensModel::kPolynomial, {0.52, -2.6, 0.0007, -0.0003, 1.48, 0.40, -2.43, 1.41}},
     {{{0.303633768976961, -0.202357512651307},
       {-0.643417413931334, 0.425762850341688},
       {0.0500139467084086, 0.0100047653416817},
       {0.732933241670153, 0.576617672026549}}}},
    {{LensModel::kPolynomial,
      {0.1, -0.05, 0.001, 0.002, 0.01, 0.02, -0.01, 0.003, 0.002, -0.001, 0.0015, 0.0007}},
     {{{0.303657808831984, -0.201766309221322},
       {-0.637458256915341, 0.424399494331113},
       {0.0500317791867839, 0.0100107819213568},
       {0.734185408891114, 0.577283611985875}}}},
    {{LensModel::kFisheye, {-0.0132, 0.0421, -0.0380, 0.0065}},
     {{{0.287628747699287, -0.191752498466192},
       {-0.532753403675774, 0.352304670172689},
       {0.0499550367273385, 0.0099910073454677},
       {0.571776951531646, 0.449253319060579}}}},
}};

TEST(Lens, ShowsPointsWhereOpenCvShowsThem) {
  for (const Known& known : kKnown) {
    const Lens lens(known.lens);
    for (std::size_t i = 0; i < kIdeal.size(); ++i) {
      const auto seen = lens.SeenOf(kIdeal.at(i));
      ASSERT_TRUE(seen);
      EXPECT_LT((*seen - known.seen.at(i)).norm(), 1e-13);
    }
  }
}

TEST(Lens, IsUndoneExactly) {
  for (const Known& known : kKnown) {
    const Lens lens(known.lens);
    for (std::size_t i = 0; i < kIdeal.size(); ++i) {
      for (const Eigen::Vector2d& guess : {known.seen.at(i), Eigen::Vector2d(0, 0), kIdeal[3]}) {
        const auto ideal = lens.IdealOf(known.seen.at(i), guess);
        ASSERT_TRUE(ideal);
        EXPECT_LT((*ideal - kIdeal.at(i)).norm(), 1e-11);
      }
    }
  }
}

// What librealsense calls so takes what is seen to what is ideal by the polynomial of the others.
TEST(Lens, OfTheInverseModelIsTheOtherOnesInverse) {
  LensDistortion inverse = kKnown[0].lens;
  inverse.model = LensModel::kInverseBrown;
  const Lens lens(inverse);
  for (std::size_t i = 0; i < kIdeal.size(); ++i) {
    EXPECT_LT((*lens.IdealOf(kIdeal.at(i)) - kKnown[0].seen.at(i)).norm(), 1e-13);
    EXPECT_LT((*lens.SeenOf(kKnown[0].seen.at(i)) - kIdeal.at(i)).norm(), 1e-11);
  }
}

TEST(Lens, ShowsNothingBeyondWhereItsPolynomialTurnsBack) {
  // r (1 - 0.5 r^2) grows up to r = 0.8165, where it is 0.5443
  const Lens lens({LensModel::kPolynomial, {-0.5}});
  EXPECT_NEAR(lens.IdealOf({0.54, 0})->x(), 0.756285, 1e-6);
  EXPECT_FALSE(lens.IdealOf({0.56, 0}));
  EXPECT_TRUE(lens.SeenOf({0.8, 0}));
  EXPECT_FALSE(lens.SeenOf({0.9, 0})) << "it lies on the way back";
  EXPECT_TRUE(lens.SeenOf({0.3, 0.3}));
  const Lens fisheye({LensModel::kFisheye, {-0.3}});
  EXPECT_FALSE(fisheye.IdealOf({0.75, 0})) << "theta (1 - 0.3 theta^2) is 0.7027 at most";
}

TEST(Lens, RefusesWhatIsNotFinite) {
  EXPECT_THROW(Lens({LensModel::kPolynomial, {std::nan("")}}), Error);
}

// A wall at z = 2 before a camera at the origin; each pixel's depth is 2, wherever it looks.
TEST(PixelDirections, PutTheCloudOfADistortedPictureOntoTheWall) {
  const PinholeView view{64, 48, 40, 42, 31, 25, RigidTransform::Identity()};
  const Lens lens(kKnown[0].lens);
  const PixelDirections directions = DirectionsOf(view, lens);
  DepthImage image{64, 48, std::vector<float>(64 * 48, 2.0F), {}, {}};
  image.label.assign(image.depth_m.size(), 0);
  image.depth_m[0] = 0;  // holes, as cameras say them
  image.depth_m[1] = std::numeric_limits<float>::quiet_NaN();
  image.depth_m[2] = std::numeric_limits<float>::infinity();
  image.depth_m[3] = -1;
  const LabelledCloud cloud =
      CropCloud(image, RigidTransform::Identity(), directions, {.min_height_m = 0.1});
  ASSERT_EQ(cloud.label.size(), image.depth_m.size() - 4);
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    // OpenCV's words: pixel = K distorted(point)
    const std::size_t pixel = i + 4;
    const double x = cloud.xyz[3 * i] / 2.0;
    const double y = cloud.xyz[3 * i + 1] / 2.0;
    const double r2 = x * x + y * y;
    const double radial = 1 - 0.28 * r2 + 0.09 * r2 * r2 - 0.012 * r2 * r2 * r2;
    const double u = x * radial + 2 * 0.0012 * x * y - 0.0008 * (r2 + 2 * x * x);
    const double v = y * radial + 0.0012 * (r2 + 2 * y * y) - 2 * 0.0008 * x * y;
    EXPECT_NEAR(40 * u + 31, static_cast<double>(pixel % 64) + 0.5, 1e-4);
    EXPECT_NEAR(42 * v + 25, static_cast<double>(pixel / 64) + 0.5, 1e-4);
    EXPECT_EQ(cloud.xyz[3 * i + 2], 2.0F);
  }
  EXPECT_THROW(CropCloud(DepthImage{}, RigidTransform::Identity(), directions), Error);
}

}  // namespace
}  // namespace doorforge

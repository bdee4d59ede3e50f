// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "centred_grasp.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/rigid_transform.h"

namespace doorforge::internal {
namespace {

constexpr double kGrid = 0.002;
// Into the leaf along -x, the fingers closing along y.
const Eigen::Matrix3d kHand = (Eigen::Matrix3d() << 0, 0, -1, 0, 1, 0, 1, 0, 0).finished();

using Shape = std::function<bool(double y, double z)>;

Shape Disc(double y, double z, double radius) {
  return [=](double at_y, double at_z) { return std::hypot(at_y - y, at_z - z) <= radius; };
}

// The shape's points on a grid in the plane x, as a camera before the leaf sees them.
void Add(double x, const Shape& shape, std::uint8_t label, LabelledCloud& cloud) {
  for (double y = -0.2; y <= 0.2; y += kGrid) {
    for (double z = 0.8; z <= 1.2; z += kGrid) {
      if (!shape(y, z)) continue;
      for (const double v : {x, y, z}) cloud.xyz.push_back(static_cast<float>(v));
      cloud.label.push_back(label);
    }
  }
}

LabelledCloud Seen(const Shape& handle) {
  LabelledCloud cloud;
  Add(0.05, handle, 1, cloud);
  Add(
      0, [](double, double) { return true; }, 0, cloud);  // the leaf
  return cloud;
}

Eigen::Matrix3d Turned(double angle) {
  return kHand * RotationAbout(Eigen::Vector3d::UnitZ(), angle).linear();
}

TEST(CentredContact, IsTheMiddleOfAKnobHoweverTheHandIsTurned) {
  const LabelledCloud knob = Seen(Disc(0.03, 1.01, 0.028));
  for (const Eigen::Vector3d& contact :
       {Eigen::Vector3d(0.05, 0.03, 1.01), Eigen::Vector3d(0.05, 0.045, 1.025)}) {
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d centred =
          CentredContact(knob, contact, Turned(i * std::numbers::pi / 6));
      EXPECT_LT((centred - Eigen::Vector3d(0.05, 0.03, 1.01)).norm(), kGrid) << i;
    }
  }
}

TEST(CentredContact, StaysWhereItIsAlongABarAndGoesToItsMiddleAcross) {
  const LabelledCloud bar =
      Seen([](double y, double z) { return std::abs(y - 0.03) < 0.009 && std::abs(z - 1) < 0.08; });
  const Eigen::Vector3d contact(0.05, 0.036, 1.05);
  EXPECT_LT((CentredContact(bar, contact, kHand) - Eigen::Vector3d(0.05, 0.03, 1.05)).norm(),
            kGrid);
  for (const double turn : {-0.25, 0.2}) {
    const Eigen::Vector3d centred = CentredContact(bar, contact, Turned(turn));
    EXPECT_NEAR(centred.y(), 0.03, 1.5 * kGrid) << "a hand that does not meet it squarely";
    EXPECT_NEAR(centred.z(), 1.05, 0.006 * std::abs(turn) + kGrid);
  }
  // fingers that close along it
  const Eigen::Vector3d along = CentredContact(bar, contact, Turned(std::numbers::pi / 2));
  EXPECT_NEAR(along.z(), 1.05, 1e-9);
  const Eigen::Vector3d askew = CentredContact(bar, contact, Turned(1.4));
  EXPECT_LT((askew - contact).norm(), 0.01) << "it stays on the bar";
}

TEST(CentredContact, LooksNeitherAtNeighboursNorAtWhatThePadsDoNotReach) {
  const Shape spoke = Disc(0, 1, 0.012);
  const Shape other = Disc(0.045, 1, 0.012);
  LabelledCloud wheel = Seen([&](double y, double z) { return spoke(y, z) || other(y, z); });
  const Eigen::Vector3d contact(0.05, 0.006, 1);
  const Eigen::Vector3d middle(0.05, 0, 1);
  EXPECT_LT((CentredContact(wheel, contact, kHand) - middle).norm(), kGrid);
  LabelledCloud knob = Seen(spoke);
  Add(0.02, Disc(0.01, 0.99, 0.03), 1, knob);  // a rose 30 mm behind
  EXPECT_LT((CentredContact(knob, contact, kHand) - middle).norm(), kGrid);
  Add(0.04, Disc(0.01, 1, 0.02), 1, knob);  // one that they reach
  EXPECT_GT((CentredContact(knob, contact, kHand) - middle).norm(), 2 * kGrid);
}

TEST(CentredContact, StaysWhereNothingElseOfTheHandleIsSeen) {
  const Eigen::Vector3d contact(0.05, 0.1, 1);
  EXPECT_EQ(CentredContact(Seen([](double, double) { return false; }), contact, kHand), contact);
  EXPECT_EQ(CentredContact(Seen(Disc(0, 1, 0.02)), contact, kHand), contact) << "80 mm away";
}

}  // namespace
}  // namespace doorforge::internal

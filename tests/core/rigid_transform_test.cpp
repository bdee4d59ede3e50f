// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/rigid_transform.h"

#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

TEST(RigidTransform, RpyFollowsUrdfOrder) {
  // roll 90 degrees takes y to z, then yaw 90 degrees leaves z alone and takes x to y
  const RigidTransform t = FromXyzRpy({1, 2, 3}, {std::numbers::pi / 2, 0, std::numbers::pi / 2});
  EXPECT_TRUE((t * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(1, 2, 4), 1e-12));
  EXPECT_TRUE((t * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

TEST(RigidTransform, RpyOfInvertsFromXyzRpyAlsoAtThePoles) {
  const double half_pi = std::numbers::pi / 2;
  for (const Eigen::Vector3d& rpy :
       {Eigen::Vector3d(0.3, -0.7, 2.9), Eigen::Vector3d(half_pi, 0, -half_pi),
        Eigen::Vector3d(0.4, half_pi, 0.9), Eigen::Vector3d(0.4, -half_pi, 0.9)}) {
    const Eigen::Matrix3d rotation = FromXyzRpy({0, 0, 0}, rpy).linear();
    const Eigen::Matrix3d again = FromXyzRpy({0, 0, 0}, RpyOf(rotation)).linear();
    EXPECT_TRUE(again.isApprox(rotation, 1e-9)) << rpy.transpose();
  }
}

TEST(RigidTransform, JsonKeepsThePose) {
  const RigidTransform t = FromXyzRpy({0.1, -2, 3}, {2.5, 0.4, -1});
  const RigidTransform again = TransformFromJson(TransformToJson(t), "t");
  EXPECT_TRUE(again.isApprox(t, 1e-12));
}

TEST(RigidTransform, JsonRefusesAQuaternionThatIsNoRotation) {
  nlohmann::ordered_json json = TransformToJson(RigidTransform::Identity());
  json["quaternion_xyzw"] = {0, 0, 0, 2};
  EXPECT_THROW(TransformFromJson(json, "t"), Error);
  json["quaternion_xyzw"] = {0, 0, "0", 1};
  EXPECT_THROW(TransformFromJson(json, "t"), Error);
}

}  // namespace
}  // namespace doorforge

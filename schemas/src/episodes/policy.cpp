// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/policy.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr std::size_t kControlledJoints = 9;  // two sliders and seven arm joints
constexpr std::size_t kVelocityOffset = 11;

Eigen::Vector3f At(const Proprioception& proprioception, std::size_t offset) {
  return {proprioception[offset], proprioception[offset + 1], proprioception[offset + 2]};
}

// Any unit vector at right angles to `row`.
Eigen::Vector3d AnyNormal(const Eigen::Vector3d& row) { return row.unitOrthogonal(); }

}  // namespace

PolicyState PolicyStateOf(const Proprioception& proprioception) {
  PolicyState state{};
  std::copy_n(proprioception.begin(), kControlledJoints, state.begin());
  std::copy_n(proprioception.begin() + kVelocityOffset, kControlledJoints,
              state.begin() + kControlledJoints);
  return state;
}

Eigen::Vector3f BasePositionOf(const Proprioception& proprioception) {
  return At(proprioception, 22);
}

Eigen::Vector3f HandPositionOf(const Proprioception& proprioception) {
  return At(proprioception, 25);
}

Eigen::Matrix3d HandRotationOf(const Proprioception& proprioception) {
  const float* xyzw = proprioception.data() + 28;
  return Eigen::Quaternionf(xyzw[3], xyzw[0], xyzw[1], xyzw[2])
      .cast<double>()
      .normalized()
      .toRotationMatrix();
}

Eigen::Vector2f FingerOpeningsOf(const Proprioception& proprioception) {
  return {proprioception[kControlledJoints], proprioception[kControlledJoints + 1]};
}

ActionVector ToVector(const Action& action) {
  ActionVector vector{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    vector[i] = static_cast<float>(action.position_delta_m[column]);
    vector[3 + i] = static_cast<float>(action.world_from_hand_rotation(0, column));
    vector[6 + i] = static_cast<float>(action.world_from_hand_rotation(1, column));
  }
  return vector;
}

namespace {

using Nine = Eigen::Matrix<double, 9, 1>;

void RequireFinite(const Nine& numbers) {
  Require(numbers.allFinite(), ErrorCode::kInvalidArgument, "an action must be finite");
}

Action ActionOf(const Eigen::Vector3d& delta, const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  Action action;
  action.position_delta_m = delta;
  action.world_from_hand_rotation.row(0) = x;
  action.world_from_hand_rotation.row(1) = y;
  action.world_from_hand_rotation.row(2) = x.cross(y);
  return action;
}

Action Orthonormalised(const Nine& v) {
  Eigen::Vector3d x = v.segment<3>(3);
  x = x.norm() > 1e-9 ? x.normalized() : Eigen::Vector3d::UnitX();
  Eigen::Vector3d y = v.segment<3>(6) - x * x.dot(v.segment<3>(6));
  y = y.norm() > 1e-9 ? y.normalized() : AnyNormal(x);
  return ActionOf(v.head<3>(), x, y);
}

bool IsOrthonormal(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  constexpr double kTolerance = 1e-12;
  return std::abs(x.norm() - 1) < kTolerance && std::abs(y.norm() - 1) < kTolerance &&
         std::abs(x.dot(y)) < kTolerance;
}

}  // namespace

Action FromVector(const ActionVector& vector) {
  const Nine numbers = Eigen::Map<const Eigen::Matrix<float, 9, 1>>(vector.data()).cast<double>();
  RequireFinite(numbers);
  return Orthonormalised(numbers);
}

ActionNumbers ToNumbers(const Action& action) {
  ActionNumbers numbers{};
  Eigen::Map<Nine> nine(numbers.data());
  nine.segment<3>(0) = action.position_delta_m;
  nine.segment<3>(3) = action.world_from_hand_rotation.row(0);
  nine.segment<3>(6) = action.world_from_hand_rotation.row(1);
  return numbers;
}

Action FromNumbers(const ActionNumbers& numbers) {
  const Nine nine = Eigen::Map<const Nine>(numbers.data());
  RequireFinite(nine);
  const Eigen::Vector3d x = nine.segment<3>(3);
  const Eigen::Vector3d y = nine.segment<3>(6);
  return IsOrthonormal(x, y) ? ActionOf(nine.head<3>(), x, y) : Orthonormalised(nine);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/action_check.h"

#include <cmath>
#include <string_view>

#include "doorforge/core/error.h"

#include "text_format.h"

namespace doorforge::internal {
namespace {

// Rotations in single precision are off by 1e-6; what is off by more than this was never one.
constexpr double kRotationTolerance = 1e-3;

void RequireFinite(const Eigen::Vector3d& vector, const std::string& name) {
  constexpr std::string_view kAxes = "xyz";
  for (int i = 0; i < 3; ++i)
    Require(std::isfinite(vector[i]), ErrorCode::kInvalidArgument,
            name + "." + kAxes[static_cast<std::size_t>(i)] + ": found " + Format("%g", vector[i]) +
                ", expected a finite number");
}

void RequireRotation(const Eigen::Matrix3d& matrix, const std::string& name) {
  Require(matrix.allFinite(), ErrorCode::kInvalidArgument,
          name + ": has numbers that are not finite, expected a rotation");
  const double off =
      (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  Require(off <= kRotationTolerance, ErrorCode::kInvalidArgument,
          name + ": " +
              Format("its columns are off by %.3g from being orthonormal, allowed %g", off,
                     kRotationTolerance) +
              "; FromVector() makes a rotation of any six numbers");
  Require(matrix.determinant() > 0, ErrorCode::kInvalidArgument,
          name +
              ": is a reflection, expected a rotation; FromVector() makes one of any six "
              "numbers");
}

}  // namespace

void CheckAction(const Action& action, const std::string& name) {
  RequireFinite(action.position_delta_m, name + ".position_delta_m");
  RequireRotation(action.world_from_hand_rotation, name + ".world_from_hand_rotation");
}

void CheckGrasp(const GraspCommand& grasp) {
  RequireFinite(grasp.contact_m, "grasp.contact_m");
  RequireRotation(grasp.world_from_hand_rotation, "grasp.world_from_hand_rotation");
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/orientation_sampling.h"

#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"

namespace doorforge {

std::vector<Eigen::Matrix3d> SampleOrientations(const Eigen::Vector3d& approach,
                                                const OrientationSampling& sampling, Rng& rng) {
  Require(approach.allFinite() && approach.norm() > 1e-9, ErrorCode::kInvalidArgument,
          "grasp: the approach is zero or not finite");
  // any rotation with z along the approach; the turn about it is drawn
  Eigen::Matrix3d base;
  base.col(2) = approach.normalized();
  base.col(0) = base.col(2).unitOrthogonal();
  base.col(1) = base.col(2).cross(base.col(0));
  std::vector<Eigen::Matrix3d> orientations;
  for (int i = 0; i < sampling.count; ++i) {
    const double turn = rng.Uniform(-std::numbers::pi, std::numbers::pi);
    const double about_x = sampling.tilt_rad * rng.Normal();
    const double about_y = sampling.tilt_rad * rng.Normal();
    orientations.push_back(base * RotationAbout(Eigen::Vector3d::UnitX(), about_x).linear() *
                           RotationAbout(Eigen::Vector3d::UnitY(), about_y).linear() *
                           RotationAbout(Eigen::Vector3d::UnitZ(), turn).linear());
  }
  return orientations;
}

// Rows 1 and 2 of R * diag(-1, -1, 1).
ActionVector HalfTurned(const ActionVector& grasp) {
  ActionVector turned = grasp;
  for (const std::size_t i : {3U, 4U, 6U, 7U}) turned.at(i) = -turned.at(i);
  return turned;
}

}  // namespace doorforge

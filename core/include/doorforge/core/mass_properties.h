// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace doorforge {

/// Mass, centre and inertia of a rigid body, all in one stated frame.
struct MassProperties {
  double mass_kg = 0;
  Eigen::Vector3d center_of_mass_m = Eigen::Vector3d::Zero();
  /// Inertia about the centre of mass, along the frame's axes [kg m^2]; symmetric.
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/door_inertia.h"

#include <algorithm>

namespace doorforge::internal {

double InertiaAbout(const DoorJoint& joint, const MassProperties& mass, double least) {
  const Eigen::Vector3d arm =
      mass.center_of_mass_m - joint.axis * joint.axis.dot(mass.center_of_mass_m);
  return std::max(joint.axis.dot(mass.inertia_kg_m2 * joint.axis), least) +
         mass.mass_kg * arm.squaredNorm();
}

}  // namespace doorforge::internal

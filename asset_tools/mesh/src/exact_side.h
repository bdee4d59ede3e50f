// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace doorforge {

/// On which side of the plane through a, b and c (counter-clockwise from above) d lies: 1 above, -1
/// below, 0 in it. Exact for coordinates between 1e-60 and 1e60 in size, and 0.
int SideOfPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d);

/// Whether three points lie on a line. As exact.
bool AreCollinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace doorforge

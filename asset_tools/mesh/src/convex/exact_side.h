// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace doorforge {

/// On which side of the plane through a, b and c (counter-clockwise from above) d lies: 1 above, -1
/// below, 0 in it. Exact for coordinates between 1e-60 and 1e60 in size, and 0.
int SideOfPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d);

/// It gives SideOfPlane() without asking first whether rounded numbers can tell.
int ExactSideOfPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d);

/// The rounded determinant (b - a) x (c - a) . (d - a) has the right sign where it is larger than
/// this times the same sum of products with every one positive: more than Shewchuk's
/// (7 + 56 eps) eps.
inline constexpr double kSideBound = 1e-15;

/// Whether three points lie on a line. As exact.
bool AreCollinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/schemas/door_asset.h"

#include "bullet_body.h"

namespace doorforge::internal {

// Links of a door's multibody.
inline constexpr int kHinge = 0;
inline constexpr int kHandle = 1;

/// Bullet times its own functions in global tables, which are not made for several worlds at once.
void SwitchProfilingOff();

/// Convex pieces of a link, in its frame.
std::vector<TriangleMesh> HullsOf(const DoorLink& link);

/// Leaf and handle on a fixed base.
std::vector<BulletLink> DoorLinks(const DoorAsset& door, double handle_friction);

/// Moments of inertia about the joints' axes, as the multibody has them [kg m^2].
struct DoorInertia {
  double hinge = 0;
  double handle = 0;
};
DoorInertia InertiaOf(const DoorAsset& door);

/// Viscous torque that one explicit step cannot turn into acceleration.
double DampingTorque(double damping, double velocity, double inertia, double time_step);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

/// Principal moments below these are raised to them [kg m^2].
inline constexpr double kLeastLeafInertia = 1e-2;
inline constexpr double kLeastHandleInertia = 5e-4;

/// The inertia of a link about its joint's axis [kg m^2], as the worlds simulate it.
double InertiaAbout(const DoorJoint& joint, const MassProperties& mass, double least);

}  // namespace doorforge::internal

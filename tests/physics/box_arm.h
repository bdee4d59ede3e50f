// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// An arm that nobody builds, of boxes and cylinders: six turning joints as on many industrial
/// arms, the hand pointing along its x, fingers that slide along z, are open at -0.03 and -0.01 m
/// and closed at the upper limit. Stands on the floor, names of its own.
UrdfModel BoxArm();

}  // namespace doorforge

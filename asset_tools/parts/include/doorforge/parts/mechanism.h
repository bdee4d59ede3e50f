// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/names.h"

namespace doorforge {

/// How far a handle of UniDoorManip turns [rad]: 45 degrees, a car's flap 10 degrees. The released
/// simulator sets these in place of the URDF's 86.4 degrees.
double HandleRange(Category category);

/// The paper's latch for a handle that turns up to `handle_range_rad`.
///
/// Fractions of the range at which it unlocks, from the released code: interior, storage furniture
/// and refrigerator 0.65, window and safe 0.5, car 0.9. "Handle done" is 0.75 of the range, for the
/// car 0.95 (its code has 0.75 there too, which lies below unlocking). Mechanism kNone: no latch,
/// and only the hinge spring acts.
Latch LatchOf(Category category, Mechanism mechanism, double handle_range_rad);

}  // namespace doorforge

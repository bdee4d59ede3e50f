// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// What of the latch is remembered between steps.
struct LatchState {
  bool locked = false;
  bool handle_done = false;  ///< Sticky; true from the start on a door without a latch.
};

/// State after the door and the handle have come to these angles. See Latch in door_asset.h for the
/// law (UniDoorManip, Section 3.2). A bolt is not a law of angles: its `locked` is kept as it was,
/// and follows from where the bolt is, see IsCaught() in bolt.h.
LatchState UpdatedLatch(const Latch& latch, const LatchState& before, double hinge_rad,
                        double handle_rad);

struct LatchTorques {
  double hinge_nm = 0;   ///< About the hinge; positive opens.
  double handle_nm = 0;  ///< About the handle's axis; positive unlocks.
};

/// Adds up lock effort and springs; a bolt holds by contact and adds nothing here.
LatchTorques TorquesOf(const Latch& latch, const LatchState& state, double hinge_rad,
                       double handle_rad);

}  // namespace doorforge

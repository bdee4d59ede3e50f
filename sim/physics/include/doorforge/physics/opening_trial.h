// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

struct OpeningTrialConfig {
  /// Nominal pull at the grasp, along its circle about the hinge: what UniDoorManip's sliders give.
  double pull_n = 50;
  double overload = 1.5;  ///< A locked door is pulled this much harder.
  /// Nominal turn of the handle: 80 N of two pads on a knob of 25 mm radius at a friction of 1.5.
  double handle_torque_nm = 6;
  double open_rad = 0.7853981633974483;  ///< 45 degrees, as in the paper.
  double time_step_s = 1.0 / 240;
};

/// What a door does when its handle is turned and its grasp is pulled. Angles in rad.
struct OpeningTrial {
  bool finite = true;       ///< False: the simulation diverged, and the other numbers say nothing.
  bool latched = false;     ///< There is a latch, so the next five have been tried.
  bool held = true;         ///< Stayed locked, and the hinge below 0.01, under the overload.
  double given_rad = 0;     ///< Largest hinge angle under the overload.
  double turned_rad = 0;    ///< Largest handle angle under the nominal turn, without a pull.
  bool unlocked = true;     ///< The nominal turn made the handle done and released the latch.
  double returned_rad = 0;  ///< Handle angle 1 s after it was let go.
  double opened_rad = 0;    ///< Largest hinge angle under the nominal pull, the handle kept turned.
  double opened_s = 0;      ///< Since the pull began; it grows to the nominal one within 1 s.
};

/// Simulates leaf, handle and latch of a door without a robot: the same bodies, latch law, bolt and
/// damping as DoorWorld, gravity off, no contacts but those of bolt and strike. Torque and pull
/// grow from 0 to the nominal ones within a second. A pushed door is pushed: the force has the
/// sense in which its hinge opens.
///
/// Any side and opening; deterministic. Throws Error(kInvalidArgument) as RequireSimulatable() and
/// BoltOf(), for a moving link without mass, or a hull of fewer than four points.
OpeningTrial TryOpening(const DoorAsset& door, const OpeningTrialConfig& config = {});

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"

namespace doorforge {

struct ComposeConfig {
  std::string id = {};  ///< Empty: "<body id>__<handle id>".
  double handle_height_m =
      0;                 ///< Above the body's lowest point; 0: where the body's author put it.
  double backset_m = 0;  ///< Handle to free edge of the leaf; 0: as the body's author put it.
  bool latch = true;     ///< False: the handle turns but nothing locks.
  double lock_effort_nm = 150;
  double hinge_spring_nm_per_rad = 3;
  double handle_spring_nm_per_rad = 3;
  bool relatch = false;
  double hinge_damping_nm_s = 0.5;  ///< Not in the paper; keeps a released leaf from coasting.
  double handle_damping_nm_s = 0.05;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("id", self.id);
    visit("handle_height_m", self.handle_height_m);
    visit("backset_m", self.backset_m);
    visit("latch", self.latch);
    visit("lock_effort_nm", self.lock_effort_nm);
    visit("hinge_spring_nm_per_rad", self.hinge_spring_nm_per_rad);
    visit("handle_spring_nm_per_rad", self.handle_spring_nm_per_rad);
    visit("relatch", self.relatch);
    visit("hinge_damping_nm_s", self.hinge_damping_nm_s);
    visit("handle_damping_nm_s", self.handle_damping_nm_s);
  }
};

/// [kg m^2] What a handle turns with at least, about every axis: a lighter one makes a step of
/// 1/240 s unstable under a stiff grasp. The missing rest is added to the grip's inertia.
inline constexpr double kMinimumHandleInertia = 5e-4;

/// Puts a handle on a body of the same category, whatever both come from.
///
/// The handle goes to the body's mount (or to `handle_height_m` and `backset_m`). It is moved along
/// x until its back rests on the leaf's real surface as seen from outside, so that it is neither
/// buried nor afloat, and in the leaf's plane by as much as its back would reach beyond the leaf's
/// outline. Latch, thresholds and range follow LatchOf(). Deterministic.
///
/// @throws Error(kInvalidArgument) if roles or categories do not match, the leaf has no surface at
///     the mount, or the handle's back is larger than the leaf; Error(kInvalidConfig) on a config
///     value out of range.
DoorAsset ComposeDoor(const Part& body, const Part& handle, const ComposeConfig& config);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/latch_law.h"

namespace doorforge {
namespace {

constexpr double kAjarAngle = 0.01;  // UniDoorManip's code: from here on the latch does not catch

}  // namespace

LatchState UpdatedLatch(const Latch& latch, const LatchState& before, double hinge_rad,
                        double handle_rad) {
  if (latch.type == LatchType::kNone) return {false, true};
  LatchState after;
  const bool ajar = !latch.relatch && !before.locked && hinge_rad > kAjarAngle;
  after.locked = handle_rad <= latch.unlock_angle_rad && !ajar;
  after.handle_done = before.handle_done || handle_rad >= latch.handle_done_angle_rad;
  return after;
}

LatchTorques TorquesOf(const Latch& latch, const LatchState& state, double hinge_rad,
                       double handle_rad) {
  const double hinge =
      state.locked ? -latch.lock_effort_nm : -latch.hinge_spring_nm_per_rad * hinge_rad;
  return {hinge, -latch.handle_spring_nm_per_rad * handle_rad};
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/latch_law.h"

#include <cmath>

namespace doorforge {
namespace {

constexpr double kAjarAngle = 0.01;  // UniDoorManip's code: from here on the latch does not catch

}  // namespace

LatchState UpdatedLatch(const Latch& latch, const LatchState& before, double hinge_rad,
                        double handle_rad) {
  if (latch.type == LatchType::kNone) return {false, true};
  LatchState after;
  after.handle_done = before.handle_done || handle_rad >= latch.handle_done_angle_rad;
  if (latch.type == LatchType::kBolt) {
    after.locked = before.locked;
    return after;
  }
  const bool free = latch.unlocks_ajar ? std::abs(hinge_rad) > kAjarAngle
                                       : !latch.relatch && !before.locked && hinge_rad > kAjarAngle;
  after.locked = handle_rad <= latch.unlock_angle_rad && !free;
  return after;
}

LatchTorques TorquesOf(const Latch& latch, const LatchState& state, double hinge_rad,
                       double handle_rad) {
  const bool held = state.locked && latch.type == LatchType::kEffort;
  const double hinge = held ? -latch.lock_effort_nm : -latch.hinge_spring_nm_per_rad * hinge_rad;
  return {hinge, -latch.handle_spring_nm_per_rad * handle_rad};
}

}  // namespace doorforge

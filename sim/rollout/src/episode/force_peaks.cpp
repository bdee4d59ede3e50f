// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/force_peaks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doorforge::internal {
namespace {

// It is that of a first-order low-pass at 10 Hz: what a wrist sensor's reading is after its usual
// filter.
constexpr double kForceFilter = 1 / (2 * std::numbers::pi * 10);  // [s]

}  // namespace

void ForcePeaks::Note(const DoorContacts& contacts, double time_step_s) {
  const double normal = contacts.pad_force_n[0] + contacts.pad_force_n[1] + contacts.arm_force_n;
  normal_n_ = std::max(normal_n_, normal);
  const double share = 1 - std::exp(-time_step_s / kForceFilter);
  filtered_n_ += share * (contacts.force_on_door_n - filtered_n_);
  net_n_ = std::max(net_n_, filtered_n_.norm());
}

}  // namespace doorforge::internal

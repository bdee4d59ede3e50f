// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/force_governor.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

constexpr double kLeastShare = 0.02;  // which still moves an arm that nothing holds
constexpr double kMostTaken = 0.5;    // in a step, so that one impact does not let the arm go
constexpr double kGivenBack = 1.05;   // in a step

}  // namespace

void ForceGovernor::Note(double force_n) {
  if (!IsOn()) return;
  share_ = force_n > most_n_
               ? std::max(kLeastShare, share_ * std::max(kMostTaken, most_n_ / force_n))
               : std::min(1.0, share_ * kGivenBack);
}

void GripWatch::Note(bool closing, bool touching) {
  held_ = closing && (held_ || touching);
  steps_without_ = touching ? 0 : steps_without_ + 1;
}

}  // namespace doorforge::internal

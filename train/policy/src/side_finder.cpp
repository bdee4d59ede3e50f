// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/side_finder.h"

#include <utility>

namespace doorforge {

void SideFinder::Begin(std::optional<LabelledCloud> before) {
  before_ = std::move(before);
  side_.reset();
}

HingeSide SideFinder::SideFor(const Eigen::Vector3f& hand_m) {
  if (choice_ != SideChoice::kAuto)
    return choice_ == SideChoice::kLeft ? HingeSide::kLeft : HingeSide::kRight;
  if (!side_) {
    const bool left = !classifier_ || !before_ || before_->xyz.empty() ||
                      classifier_->LogOddsOfLeft(SideNumbersOf(before_->xyz, hand_m)) >= 0;
    side_ = left ? HingeSide::kLeft : HingeSide::kRight;
  }
  return *side_;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/side_finder.h"

#include <cmath>
#include <utility>

namespace doorforge {
namespace {

constexpr double kClearLogOdds = 3;  // 95 to 5

}  // namespace

void SideFinder::Begin(std::optional<LabelledCloud> before) {
  before_ = std::move(before);
  side_.reset();
  is_clear_ = false;
  ++episode_;
}

HingeSide SideFinder::SideFor(const Eigen::Vector3f& hand_m) {
  if (choice_ != SideChoice::kAuto)
    return choice_ == SideChoice::kLeft ? HingeSide::kLeft : HingeSide::kRight;
  if (!side_) first_ = SideFromPicture(hand_m);
  if (!side_) side_ = first_;
  return *side_;
}

HingeSide SideFinder::SideFromPicture(const Eigen::Vector3f& hand_m) {
  if (!classifier_ || !before_ || before_->xyz.empty()) return HingeSide::kLeft;
  const double odds = classifier_->LogOddsOfLeft(SideNumbersOf(before_->xyz, hand_m));
  is_clear_ = std::fabs(odds) > kClearLogOdds;
  return odds < -kClearLogOdds ? HingeSide::kRight : HingeSide::kLeft;
}

void SideFinder::Confirm(HingeSide side) {
  side_ = first_ = side;
  is_clear_ = true;
}

void SideFinder::GoOver() {
  if (!is_clear_) first_ = Opposite(first_);
  side_ = first_;
}

}  // namespace doorforge

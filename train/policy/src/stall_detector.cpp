// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/stall_detector.h"

#include <cmath>
#include <cstddef>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"

namespace doorforge {
namespace {

constexpr double kArm = 0.1;  // [m] by which turns are weighed against shifts

Eigen::Vector3d TurnBetween(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  return RotationVector(to * from.transpose());
}

// Of a hand from where it was [m], its turn weighed as above.
double WayBetween(const Proprioception& from, const Proprioception& to) {
  const double shift = static_cast<double>((HandPositionOf(to) - HandPositionOf(from)).norm());
  const double turn = TurnBetween(HandRotationOf(from), HandRotationOf(to)).norm();
  return std::hypot(shift, kArm * turn);
}

}  // namespace

StallDetector::StallDetector(const StallConfig& config) : config_(config) {
  Require(config.patience >= 1 && config.patience <= 100, ErrorCode::kInvalidConfig,
          "policy.stall.patience: must be 1 to 100");
  Require(config.moved_share >= 0 && config.moved_share <= 1, ErrorCode::kInvalidConfig,
          "policy.stall.moved_share: must be 0 to 1");
}

void StallDetector::Reset() {
  start_.reset();
  before_.reset();
  shares_.clear();
}

void StallDetector::Answer(const Proprioception& now) {
  if (!before_) return;
  const Eigen::Matrix3d rotation = HandRotationOf(*before_);
  const Eigen::Vector3d turn = TurnBetween(rotation, asked_.world_from_hand_rotation);
  const Eigen::Vector3d turned = TurnBetween(rotation, HandRotationOf(now));
  const Eigen::Vector3d moved = (HandPositionOf(now) - HandPositionOf(*before_)).cast<double>();
  shares_.push_back({moved.dot(asked_.position_delta_m) + kArm * kArm * turned.dot(turn),
                     asked_.position_delta_m.squaredNorm() + kArm * kArm * turn.squaredNorm()});
  if (shares_.size() > static_cast<std::size_t>(config_.patience)) shares_.pop_front();
  before_.reset();
}

bool StallDetector::Stalls(const Proprioception& now) {
  Answer(now);
  if (shares_.size() < static_cast<std::size_t>(config_.patience)) return false;
  if (WayBetween(*start_, now) > config_.within_m) return false;
  Share sum;
  for (const Share& share : shares_) {
    sum.done += share.done;
    sum.asked += share.asked;
  }
  return sum.done < config_.moved_share * sum.asked;
}

void StallDetector::Ask(const Proprioception& now, const Action& action) {
  Answer(now);
  if (!start_) start_ = now;
  before_ = now;
  asked_ = action;
}

}  // namespace doorforge

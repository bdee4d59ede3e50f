// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/trying_policy.h"

#include <cstddef>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/mirror.h"

namespace doorforge {
namespace {

constexpr double kOnTheWay = 0.12;       // [m] farther than a hand goes with a handle that it turns
constexpr double kLeastSideways = 0.01;  // [m] an action
constexpr double kLever = 0.1;           // [m] by which turns are weighed against shifts

Eigen::Vector3d TurnBetween(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  return RotationVector(to * from.transpose());
}

}  // namespace

double StallDetector::WayFromStart(const Proprioception& now) const {
  if (!start_) return 0;
  return static_cast<double>((HandPositionOf(now) - HandPositionOf(*start_)).norm());
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
  const double sideways = asked_.position_delta_m.y();
  shares_.push_back({moved.dot(asked_.position_delta_m) + kLever * kLever * turned.dot(turn),
                     asked_.position_delta_m.squaredNorm() + kLever * kLever * turn.squaredNorm(),
                     moved.y() * sideways, sideways * sideways});
  while (shares_.size() > static_cast<std::size_t>(config_.patience)) shares_.pop_front();
  before_.reset();
}

bool StallDetector::IsFull() const {
  return shares_.size() >= static_cast<std::size_t>(config_.patience);
}

StallDetector::Share StallDetector::Sum() const {
  Share sum;
  for (const Share& share : shares_) {
    sum.done += share.done;
    sum.asked += share.asked;
    sum.sideways_done += share.sideways_done;
    sum.sideways_asked += share.sideways_asked;
  }
  return sum;
}

bool StallDetector::Stalls(const Proprioception& now) {
  Answer(now);
  if (!IsFull() || WayFromStart(now) > config_.within_m) return false;
  const Share sum = Sum();
  return sum.done < config_.moved_share * sum.asked;
}

bool StallDetector::IsHeldSideways(const Proprioception& now) const {
  if (!IsFull() || WayFromStart(now) > kOnTheWay) return false;
  const Share sum = Sum();
  return sum.sideways_asked > config_.patience * kLeastSideways * kLeastSideways &&
         sum.sideways_done < config_.sideways_share * sum.sideways_asked;
}

void StallDetector::Ask(const Proprioception& now, const Action& action) {
  Answer(now);
  if (!start_) start_ = now;
  before_ = now;
  asked_ = action;
}

TryingPolicy::TryingPolicy(std::unique_ptr<TwoWayPolicy> policy, const StallConfig& config,
                           std::vector<MotionWay> ways, std::shared_ptr<SideFinder> finder)
    : policy_(std::move(policy)),
      stall_(config),
      ways_(std::move(ways)),
      finder_(std::move(finder)) {
  Require(config.patience >= 1 && config.patience <= 100, ErrorCode::kInvalidConfig,
          "policy.stall.patience: must be 1 to 100");
  Require(config.moved_share >= 0 && config.moved_share <= 1, ErrorCode::kInvalidConfig,
          "policy.stall.moved_share: must be 0 to 1");
}

void TryingPolicy::Reset() {
  policy_->Reset();
  stall_.Reset();
  guesses_.clear();
  changed_ = false;
}

// Both ways on the likelier side before the other side.
void TryingPolicy::Begin(const Observation& observation) {
  HingeSide side = HingeSide::kLeft;
  if (finder_) {
    // the same stage once more: what came before led nowhere
    if (episode_ == finder_->episode()) finder_->GoOver();
    episode_ = finder_->episode();
    side = finder_->SideFor(HandPositionOf(observation.proprioception));
  }
  for (const MotionWay way : ways_) guesses_.push_back({side, way});
  if (finder_ && finder_->MayChange()) {
    for (const MotionWay way : ways_) guesses_.push_back({Opposite(side), way});
  }
  tried_ = 0;
  guess_ = guesses_.front();
}

Action TryingPolicy::Act(const Observation& observation) {
  if (guesses_.empty()) Begin(observation);
  const Proprioception& now = observation.proprioception;
  changed_ =
      guesses_.size() > 1 && (stall_.Stalls(now) || (IsInDoubt() && stall_.IsHeldSideways(now)));
  if (changed_) {
    guess_ = guesses_[++tried_ % guesses_.size()];
    stall_.Reset();
  } else if (tried_ > 0 && finder_ && stall_.IsFull()) {
    finder_->Found(guess_.side);  // a handle that does not turn either way has shown nothing
  }
  if (finder_ && stall_.WayFromStart(now) > kOnTheWay) finder_->Confirm(guess_.side);
  const Action action = guess_.side == HingeSide::kLeft
                            ? policy_->Act(observation, guess_.way)
                            : AsShown(policy_->Act(AsShown(observation), guess_.way));
  stall_.Ask(now, action);
  return action;
}

bool TryingPolicy::IsInDoubt() const { return finder_ && !finder_->IsClear(); }

Observation TryingPolicy::AsShown(Observation observation) const {
  if (guess_.side == HingeSide::kLeft) return observation;
  observation.cloud = MirroredSideways(std::move(observation.cloud));
  observation.proprioception = MirroredSideways(observation.proprioception);
  return observation;
}

Action TryingPolicy::AsShown(const Action& action) const {
  if (guess_.side == HingeSide::kLeft) return action;
  return FromVector(MirroredSideways(ToVector(action)));
}

}  // namespace doorforge

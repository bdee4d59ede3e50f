// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/door_belief.h"

#include <algorithm>
#include <utility>

#include "logistic_regression.h"

namespace doorforge {
namespace {

constexpr double kReversedShare = 0.3;        // of handles
constexpr double kPushedShare = 0.25;         // of doors
constexpr double kForeignPushedShare = 0.01;  // of those that are nothing like those learned
constexpr double kRightFails = 0.05;          // the chance that a right guess leads nowhere
constexpr double kSlipsUnnoticed =
    0.5;  // that a hand stalls nowhere though the handle stands still
constexpr double kAgainstTheStop = 0.02;  // that a leaf comes though it opens the other way
// That a leaf comes a little and no farther, where either the arc or the handle's sense is wrong,
// and where both are: the mirror image of a handle turns the other way.
constexpr double kWrongArcOrTurn = 0.5;
constexpr double kWrongArcAndTurn = 0.25;
constexpr double kLeastDoubt = 0.02;  // about the side, however clear the picture

// Whether the hand does the same with the handle.
bool TurnAlike(const DoorGuess& one, const DoorGuess& other) {
  return one.side == other.side && one.turning == other.turning;
}

}  // namespace

void DoorBelief::Begin(std::optional<LabelledCloud> before) {
  before_ = std::move(before);
  is_weighed_ = handle_stalled_ = leaf_follows_ = gives_up_ = false;
  reached_.reset();
}

double DoorBelief::LeftShare(const Eigen::Vector3f& hand_m) const {
  if (told_.side != SideChoice::kAuto) return told_.side == SideChoice::kLeft ? 1 : 0;
  if (!knowledge_.side || !IsSeen()) return 0.5;
  const double log_odds = knowledge_.side->LogOddsOfLeft(SideNumbersOf(before_->xyz, hand_m));
  return std::clamp(internal::Logistic(log_odds), kLeastDoubt, 1 - kLeastDoubt);
}

double DoorBelief::PushedShare() const {
  if (told_.opening != OpeningChoice::kAuto) return told_.opening == OpeningChoice::kPush ? 1 : 0;
  const bool is_foreign =
      knowledge_.pushed && IsSeen() && !knowledge_.pushed->Knows(HeightInView(before_->xyz));
  return is_foreign ? kForeignPushedShare : kPushedShare;
}

double DoorBelief::ReversedShare() const {
  if (told_.turning != TurningChoice::kAuto)
    return told_.turning == TurningChoice::kReversed ? 1 : 0;
  return kReversedShare;
}

void DoorBelief::Weigh(const Eigen::Vector3f& hand_m) {
  if (is_weighed_) return;
  is_weighed_ = true;
  const double left = LeftShare(hand_m);
  const double reversed = ReversedShare();
  const double pushed = PushedShare();
  auto* next = weighed_.begin();
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const MotionWay turning : {MotionWay::kUsual, MotionWay::kOther}) {
      for (const MotionWay opening : {MotionWay::kUsual, MotionWay::kOther})
        *next++ = {{side, turning, opening},
                   (side == HingeSide::kLeft ? left : 1 - left) *
                       (turning == MotionWay::kOther ? reversed : 1 - reversed) *
                       (opening == MotionWay::kOther ? pushed : 1 - pushed)};
    }
  }
}

// The chance that the leaf comes some way with the present grasp and no farther.
double DoorBelief::ChanceThatItFollowed(const DoorGuess& truth) const {
  if (truth == guess_) return kRightFails;
  if (truth.opening != guess_.opening) return kAgainstTheStop;
  const bool both_are_wrong = truth.side != guess_.side && truth.turning == guess_.turning;
  return both_are_wrong ? kWrongArcAndTurn : kWrongArcOrTurn;
}

// The chance that the present grasp goes as it went, at a door that is as guessed there.
double DoorBelief::ChanceOfFailure(const DoorGuess& truth) const {
  if (leaf_follows_) return ChanceThatItFollowed(truth);
  const bool is_handle_to_blame = handle_stalled_ || reached_ == Stage::kHandle;
  if (TurnAlike(truth, guess_)) return is_handle_to_blame || truth == guess_ ? kRightFails : 1;
  return is_handle_to_blame ? 1 : kSlipsUnnoticed;
}

void DoorBelief::NextGrasp() {
  if (!reached_) return;
  for (Weighed& one : weighed_) one.weight *= ChanceOfFailure(one.guess);
  reached_.reset();
  handle_stalled_ = leaf_follows_ = gives_up_ = false;
}

void DoorBelief::NoteStall(Stage stage) {
  handle_stalled_ = handle_stalled_ || stage == Stage::kHandle;
  gives_up_ = gives_up_ || stage == Stage::kOpen;
}

const DoorGuess& DoorBelief::ForGrasp(const Eigen::Vector3f& contact_m) {
  NextGrasp();
  Weigh(contact_m);
  // the first of equals
  guess_ = std::ranges::max_element(weighed_, {}, &Weighed::weight)->guess;
  return guess_;
}

const DoorGuess& DoorBelief::ForStage(Stage stage, const Eigen::Vector3f& hand_m) {
  const bool goes_on = reached_ == Stage::kHandle && stage == Stage::kOpen;
  if (!goes_on) ForGrasp(hand_m);
  reached_ = stage;
  return guess_;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/mirroring_policy.h"

#include <utility>

#include "doorforge/schemas/mirror.h"

namespace doorforge {

void MirroringPolicy::Reset() {
  policy_->Reset();
  stall_.Reset();
  following_.Reset();
  has_begun_ = is_stalled_ = false;
}

bool MirroringPolicy::IsUpsideDown() const {
  const bool is_told = role_.stage == Stage::kHandle && role_.knows_both_ways;
  return guess_.turning == MotionWay::kOther && !is_told;
}

MotionWay MirroringPolicy::Way() const {
  if (!role_.knows_both_ways) return MotionWay::kUsual;
  return role_.stage == Stage::kOpen ? guess_.opening : guess_.turning;
}

Action MirroringPolicy::Act(const Observation& observation) {
  const Proprioception& now = observation.proprioception;
  if (!has_begun_ && role_.belief)
    guess_ = role_.belief->ForStage(role_.stage, HandPositionOf(now));
  has_begun_ = true;
  Feel(now);
  const Action action = IsShownAsItIs() ? policy_->Act(observation, Way())
                                        : AsShown(policy_->Act(AsShown(observation), Way()));
  stall_.Ask(now, action);
  return action;
}

void MirroringPolicy::Feel(const Proprioception& now) {
  if (!role_.belief || !role_.belief->LeavesOpen()) return;
  if (role_.stage == Stage::kOpen && following_.Follows(now)) role_.belief->NoteLeafFollows();
  if (is_stalled_ || !stall_.Stalls(now)) return;
  is_stalled_ = true;
  role_.belief->NoteStall(role_.stage);
}

bool MirroringPolicy::IsShownAsItIs() const {
  return guess_.side == HingeSide::kLeft && !IsUpsideDown();
}

Observation MirroringPolicy::AsShown(Observation observation) const {
  if (guess_.side == HingeSide::kRight) {
    observation.cloud = MirroredSideways(std::move(observation.cloud));
    observation.proprioception = MirroredSideways(observation.proprioception);
  }
  if (IsUpsideDown()) {
    observation.cloud = MirroredUpright(std::move(observation.cloud));
    observation.proprioception = MirroredUpright(observation.proprioception);
  }
  return observation;
}

// Either mirror exchanges the fingers, so both together turn the hand half round twice: in any
// order they are each other's inverse.
Action MirroringPolicy::AsShown(const Action& action) const {
  if (IsShownAsItIs()) return action;
  ActionVector vector = ToVector(action);
  if (guess_.side == HingeSide::kRight) vector = MirroredSideways(vector);
  if (IsUpsideDown()) vector = MirroredUpright(vector);
  return FromVector(vector);
}

}  // namespace doorforge

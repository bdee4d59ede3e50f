// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "hand_frame.h"

namespace doorforge::internal {

ActionVector TurnOf(const ActionVector& action, const Eigen::Matrix3d& world_from_hand) {
  Action turn = FromVector(action);
  turn.world_from_hand_rotation *= world_from_hand.transpose();
  return ToVector(turn);
}

ActionVector TargetOf(const ActionVector& turn, const Eigen::Matrix3d& world_from_hand) {
  Action target = FromVector(turn);
  target.world_from_hand_rotation *= world_from_hand;
  return ToVector(target);
}

TrainingSample WithTurns(TrainingSample sample) {
  const Eigen::Matrix3d world_from_hand = HandRotationOf(sample.proprioception);
  sample.action = TurnOf(sample.action, world_from_hand);
  sample.executed = TurnOf(sample.executed, world_from_hand);
  return sample;
}

}  // namespace doorforge::internal

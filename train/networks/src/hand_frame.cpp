// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/hand_frame.h"

#include "doorforge/schemas/mirror.h"

namespace doorforge {

namespace {

void TurnSign(std::vector<float>& xyz, std::size_t axis) {
  for (std::size_t i = axis; i < xyz.size(); i += 3) xyz[i] = -xyz[i];
}

}  // namespace

std::span<const float> ShownCloud(const TrainingSample& sample, std::vector<float>& storage) {
  if (!sample.is_mirrored && !sample.is_upside_down) return sample.cloud;
  storage.assign(sample.cloud.begin(), sample.cloud.end());
  if (sample.is_mirrored) TurnSign(storage, 1);
  if (sample.is_upside_down) TurnSign(storage, 2);
  return storage;
}

namespace internal {

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

TrainingSample WithTurns(const TrainingSample& sample) {
  const Eigen::Matrix3d world_from_hand = HandRotationOf(sample.proprioception);
  TrainingSample turns = sample;
  turns.action = TurnOf(sample.action, world_from_hand);
  turns.executed = TurnOf(sample.executed, world_from_hand);
  return turns;
}

TrainingSample WithoutCloudMirrored(const TrainingSample& sample) {
  TrainingSample mirrored = sample;
  mirrored.proprioception = MirroredSideways(sample.proprioception);
  mirrored.action = MirroredSideways(sample.action);
  mirrored.executed = MirroredSideways(sample.executed);
  return mirrored;
}

TrainingSample InMirror(const TrainingSample& sample) {
  TrainingSample mirrored = WithoutCloudMirrored(sample);
  mirrored.is_mirrored = !sample.is_mirrored;
  return mirrored;
}

TrainingSample UpsideDown(const TrainingSample& sample) {
  TrainingSample mirrored = sample;
  mirrored.proprioception = MirroredUpright(sample.proprioception);
  mirrored.action = MirroredUpright(sample.action);
  mirrored.executed = MirroredUpright(sample.executed);
  mirrored.way = Opposite(sample.way);
  mirrored.is_upside_down = !sample.is_upside_down;
  return mirrored;
}

TrainingSample AboutContact(const TrainingSample& sample) {
  TrainingSample about = sample;
  for (std::size_t k = 0; k < 3; ++k) about.action[k] -= sample.cloud[k];
  return about;
}

}  // namespace internal
}  // namespace doorforge

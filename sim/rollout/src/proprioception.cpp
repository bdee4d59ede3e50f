// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/run_episode.h"

namespace doorforge {

Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base) {
  Proprioception result{};
  std::size_t at = 0;
  const auto put = [&](double number) { result.at(at++) = static_cast<float>(number); };
  for (int i = 0; i < kRobotJointCount; ++i) {
    const RobotJoint& joint = robot.joints()[static_cast<std::size_t>(i)];
    const double range = joint.upper - joint.lower;
    put(2 * (state.robot_position[i] - joint.lower) / range - 1);
  }
  for (int i = 0; i < kRobotJointCount; ++i) put(state.robot_velocity[i]);
  const RigidTransform hand = robot.PoseAt(state.robot_position, world_from_base).world_from_hand;
  for (const double x : world_from_base.translation()) put(x);
  for (const double x : hand.translation()) put(x);
  Eigen::Quaterniond turn(hand.linear());
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  for (const double x : turn.coeffs()) put(x);
  return result;
}

}  // namespace doorforge

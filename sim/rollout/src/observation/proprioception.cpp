// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/proprioception.h"

#include "doorforge/core/error.h"

namespace doorforge {

bool HasProprioception(const RobotModel& robot) {
  return robot.base() != RobotBase::kYaw && robot.arm_count() - robot.base_count() == 7;
}

Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base) {
  Require(HasProprioception(robot), ErrorCode::kInvalidArgument,
          "robot \"" + robot.name() + "\", base " + std::string(NameOf(robot.base())) + ": has " +
              std::to_string(robot.joint_count()) +
              " moving joints; policies and their data know two sliders (or a fixed base), seven "
              "arm joints and two fingers; let the expert run with `doorforge simulate`");
  Require(state.robot_position.size() == robot.joint_count() &&
              state.robot_velocity.size() == robot.joint_count(),
          ErrorCode::kInvalidArgument, "proprioception: the state is of another robot");
  Proprioception result{};
  std::size_t at = 0;
  const auto put = [&](double number) { result.at(at++) = static_cast<float>(number); };
  const int missing_sliders = kSliderCount - robot.base_count();
  for (int i = 0; i < missing_sliders; ++i) put(0);
  for (int i = 0; i < robot.joint_count(); ++i) {
    const RobotJoint& joint = robot.joint(i);
    const double range = joint.upper - joint.lower;
    put(2 * (state.robot_position[i] - joint.lower) / range - 1);
  }
  for (int i = 0; i < missing_sliders; ++i) put(0);
  for (const double velocity : state.robot_velocity) put(velocity);
  const RigidTransform hand = robot.PoseAt(state.robot_position, world_from_base).world_from_hand;
  for (const double x : world_from_base.translation()) put(x);
  for (const double x : hand.translation()) put(x);
  Eigen::Quaterniond turn(hand.linear());
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  for (const double x : turn.coeffs()) put(x);
  return result;
}

}  // namespace doorforge

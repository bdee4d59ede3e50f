// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/proprioception.h"

#include "doorforge/core/error.h"

namespace doorforge {

bool HasProprioception(const RobotModel& robot) {
  if (robot.base() == RobotBase::kFloating) return true;
  return robot.base() != RobotBase::kYaw && robot.arm_count() - robot.base_count() == 7;
}

ProprioceptionPlaces ProprioceptionPlacesOf(const RobotModel& robot) {
  Require(HasProprioception(robot), ErrorCode::kInvalidArgument,
          "robot \"" + robot.name() + "\", base " + std::string(NameOf(robot.base())) + ": has " +
              std::to_string(robot.joint_count()) +
              " moving joints; policies and their data know two sliders (or a fixed base), seven "
              "arm joints and two fingers, or a flying hand; let the expert run with `doorforge "
              "simulate`");
  ProprioceptionPlaces places;
  places.fill(-1);
  const bool flies = robot.base() == RobotBase::kFloating;
  const auto first = static_cast<std::size_t>(flies ? 0 : kSliderCount - robot.base_count());
  for (int i = 0; i < robot.arm_count(); ++i) places.at(first + static_cast<std::size_t>(i)) = i;
  places[kLeftFinger] = robot.left_finger();
  places[kRightFinger] = robot.right_finger();
  return places;
}

Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base) {
  const ProprioceptionPlaces places = ProprioceptionPlacesOf(robot);
  Require(state.robot_position.size() == robot.joint_count() &&
              state.robot_velocity.size() == robot.joint_count(),
          ErrorCode::kInvalidArgument, "proprioception: the state is of another robot");
  Proprioception result{};
  std::size_t at = 0;
  const auto put = [&](double number) { result.at(at++) = static_cast<float>(number); };
  const auto scaled = [&](int i) {
    const RobotJoint& joint = robot.joint(i);
    return 2 * (state.robot_position[i] - joint.lower) / (joint.upper - joint.lower) - 1;
  };
  for (const int i : places) put(i < 0 ? 0 : scaled(i));
  for (const int i : places) put(i < 0 ? 0 : state.robot_velocity[i]);
  const RigidTransform hand = robot.PoseAt(state.robot_position, world_from_base).world_from_hand;
  for (const double x : world_from_base.translation()) put(x);
  for (const double x : hand.translation()) put(x);
  Eigen::Quaterniond turn(hand.linear());
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  for (const double x : turn.coeffs()) put(x);
  return result;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/hand_controller.h"

#include <algorithm>

namespace doorforge {
namespace {

double AngleBetween(const RigidTransform& a, const RigidTransform& b) {
  return RotationVector(a.linear().transpose() * b.linear()).norm();
}

// Straight line for the origin, constant turn for the rotation.
RigidTransform Between(const RigidTransform& from, const RigidTransform& to, double part) {
  RigidTransform between;
  between.setIdentity();
  between.translation() = from.translation() + part * (to.translation() - from.translation());
  const Eigen::Vector3d turn = RotationVector(to.linear() * from.linear().transpose());
  const double angle = part * turn.norm();
  between.linear() =
      angle < 1e-12 ? Eigen::Matrix3d(from.linear())
                    : Eigen::Matrix3d(Eigen::AngleAxisd(angle, turn.normalized()) * from.linear());
  return between;
}

}  // namespace

HandController::HandController(const RobotModel& robot, const RigidTransform& world_from_base,
                               const JointVector& start, const HandControllerConfig& config)
    : robot_(&robot),
      world_from_base_(world_from_base),
      config_(config),
      reference_(start),
      target_(robot.PoseAt(start, world_from_base).world_from_hand) {
  goal_.posture = start;
  goal_.world_from_tcp = target_ * robot.hand_from_tcp();
}

RigidTransform HandController::CommandedHand() const {
  return goal_.world_from_tcp * robot_->hand_from_tcp().inverse();
}

void HandController::MoveHandTo(const RigidTransform& world_from_hand, double duration_s) {
  MoveHandTo(world_from_hand, duration_s, true);
}

void HandController::MoveHandTo(const RigidTransform& world_from_hand, double duration_s,
                                bool limited) {
  target_ = world_from_hand;
  const RigidTransform now = CommandedHand();
  const double distance = (target_.translation() - now.translation()).norm();
  const double turn = AngleBetween(now, target_);
  remaining_s_ =
      limited
          ? std::max({duration_s, distance / config_.max_speed_m_s, turn / config_.max_turn_rad_s})
          : 0;
  if (!limited) goal_.world_from_tcp = target_ * robot_->hand_from_tcp();
}

void HandController::AdvancePose(double time_step_s) {
  if (remaining_s_ <= 0) return;
  const double part = std::min(1.0, time_step_s / remaining_s_);
  remaining_s_ = part >= 1 ? 0 : remaining_s_ - time_step_s;
  goal_.world_from_tcp = Between(CommandedHand(), target_, part) * robot_->hand_from_tcp();
}

RobotCommand HandController::CommandOf(const JointVector& measured) {
  // the drives must not wind up against a handle stop or a locked door
  for (int i = 0; i < robot_->arm_count(); ++i)
    reference_[i] = std::clamp(reference_[i], measured[i] - config_.max_joint_lead,
                               measured[i] + config_.max_joint_lead);
  return {reference_.head(robot_->arm_count()), close_fingers, fingers_open_m, std::nullopt};
}

RobotCommand HandController::Step(const JointVector& measured, double time_step_s) {
  AdvancePose(time_step_s);
  const JointVector next = StepTowards(*robot_, world_from_base_, goal_, reference_);
  for (int i = 0; i < robot_->arm_count(); ++i) {
    const double most = robot_->joint(i).velocity * time_step_s;
    reference_[i] += std::clamp(next[i] - reference_[i], -most, most);
  }
  RobotCommand command = CommandOf(measured);
  command.world_from_tcp = goal_.world_from_tcp;
  return command;
}

RobotCommand HandController::StepJoints(const JointVector& target, const JointVector& measured,
                                        double time_step_s, double speed_fraction) {
  // all joints arrive together: the one that needs longest sets the pace
  double steps = 1;
  for (int i = 0; i < robot_->arm_count(); ++i) {
    const double most = speed_fraction * robot_->joint(i).velocity * time_step_s;
    steps = std::max(steps, std::abs(target[i] - reference_[i]) / most);
  }
  reference_.head(robot_->arm_count()) += (target - reference_).head(robot_->arm_count()) / steps;
  goal_.world_from_tcp = robot_->PoseAt(reference_, world_from_base_).world_from_tcp;
  target_ = CommandedHand();
  remaining_s_ = 0;
  return CommandOf(measured);
}

}  // namespace doorforge

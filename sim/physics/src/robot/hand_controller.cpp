// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/hand_controller.h"

#include <algorithm>

namespace doorforge {
namespace {

constexpr double kLever = 0.2;  // [m]

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
  commanded_before_ = goal_.world_from_tcp;
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

void HandController::StopAt(const JointVector& measured) {
  reference_ = measured;
  FollowHand(robot_->PoseAt(measured, world_from_base_).world_from_hand);
  commanded_before_ = goal_.world_from_tcp;
}

void HandController::AdvancePose(double time_step_s) {
  if (remaining_s_ <= 0) return;
  const double part = std::min(1.0, time_step_s / remaining_s_);
  remaining_s_ = part >= 1 ? 0 : remaining_s_ - time_step_s;
  goal_.world_from_tcp = Between(CommandedHand(), target_, part) * robot_->hand_from_tcp();
}

// A turn counts as well, as the way of a point 0.2 m beside the tool centre.
double HandController::CommandedSpeed(double time_step_s) {
  const RigidTransform& now = goal_.world_from_tcp;
  const double way_m = (now.translation() - commanded_before_.translation()).norm();
  const double turn_m = kLever * AngleBetween(commanded_before_, now);
  commanded_before_ = now;
  return (way_m + turn_m) / time_step_s;
}

// Joint by joint: by how much its own turning moves the tool centre, through its column of the
// Jacobian. A speed of the joints' targets would not do: these run along with a joint that moves.
ArmVector HandController::MostSpeed(const JointVector& measured, double hand_m_s) const {
  const ArmJacobian jacobian = robot_->TcpJacobian(robot_->PoseAt(measured, world_from_base_));
  ArmVector most(robot_->arm_count());
  for (int i = 0; i < robot_->arm_count(); ++i)
    most[i] = (hand_m_s + *config_.catch_up) / std::max(kLever, jacobian.col(i).head<3>().norm());
  return most;
}

RobotCommand HandController::CommandOf(const JointVector& measured) {
  // the drives must not wind up against a handle stop or a locked door
  for (int i = 0; i < robot_->arm_count(); ++i)
    reference_[i] = std::clamp(reference_[i], measured[i] - config_.max_joint_lead,
                               measured[i] + config_.max_joint_lead);
  RobotCommand command;
  command.arm_position = reference_.head(robot_->arm_count());
  command.close_fingers = close_fingers;
  command.fingers_open_m = fingers_open_m;
  return command;
}

RobotCommand HandController::Step(const JointVector& measured, double time_step_s) {
  AdvancePose(time_step_s);
  const JointVector next = StepTowards(*robot_, world_from_base_, goal_, reference_);
  for (int i = 0; i < robot_->arm_count(); ++i) {
    const double most = robot_->joint(i).velocity * time_step_s;
    reference_[i] += std::clamp(next[i] - reference_[i], -most, most);
  }
  RobotCommand command = CommandOf(measured);
  if (config_.catch_up) command.most_speed = MostSpeed(measured, CommandedSpeed(time_step_s));
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
  const ArmVector way = (target - reference_).head(robot_->arm_count()) / steps;
  reference_.head(robot_->arm_count()) += way;
  goal_.world_from_tcp = robot_->PoseAt(reference_, world_from_base_).world_from_tcp;
  target_ = CommandedHand();
  remaining_s_ = 0;
  commanded_before_ = goal_.world_from_tcp;
  RobotCommand command = CommandOf(measured);
  if (config_.catch_up) command.most_speed = way.cwiseAbs() / time_step_s + MostSpeed(measured, 0);
  return command;
}

}  // namespace doorforge

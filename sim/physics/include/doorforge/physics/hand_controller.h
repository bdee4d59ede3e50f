// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/inverse_kinematics.h"
#include "doorforge/physics/robot_command.h"
#include "doorforge/physics/robot_model.h"

namespace doorforge {

struct HandControllerConfig {
  double max_speed_m_s = 0.6;  ///< The commanded hand moves no faster.
  double max_turn_rad_s = 2.5;
  double max_joint_lead = 0.15;  ///< Command ahead of the measured joint [rad or m].
  /// So much faster than the commanded hand does any joint alone move a hand that has fallen behind
  /// [m/s], by its distance from the tool centre or 0.2 m, whichever is more; without it, as fast
  /// as its drive can.
  std::optional<double> catch_up = std::nullopt;
};

/// Follows hand poses: the commanded pose moves in a straight line, damped least squares turns it
/// into joint targets, step by step; the drives follow these, or, with torques, the pose. Holds the
/// runtime state of one episode.
class HandController {
 public:
  /// @param start Joint positions at the beginning; the hand is told to stay there.
  HandController(const RobotModel& robot, const RigidTransform& world_from_base,
                 const JointVector& start, const HandControllerConfig& config = {});

  /// The posture that the arm prefers where the hand's pose leaves freedom.
  void SetPosture(const JointVector& posture) { goal_.posture = posture; }

  /// Moves the commanded pose to the target within `duration_s`, or later where that would exceed
  /// the speed limits.
  void MoveHandTo(const RigidTransform& world_from_hand, double duration_s);

  /// Puts the commanded pose there at once; for targets that move smoothly by themselves.
  void FollowHand(const RigidTransform& world_from_hand) { MoveHandTo(world_from_hand, 0, false); }

  /// Stops where the joints are, and gives up all that was commanded ahead of them.
  void StopAt(const JointVector& measured);

  /// Command for the next step, given the measured joints.
  RobotCommand Step(const JointVector& measured, double time_step_s);

  /// Command for the next step of a motion towards joint positions, each joint at most at
  /// `speed_fraction` of its velocity limit. Afterwards the hand is told to stay where it came to.
  RobotCommand StepJoints(const JointVector& target, const JointVector& measured,
                          double time_step_s, double speed_fraction);

  /// Commanded pose of the hand now.
  RigidTransform CommandedHand() const;
  /// Where MoveHandTo() will end.
  const RigidTransform& target() const { return target_; }
  bool Arrived() const { return remaining_s_ <= 0; }

  bool close_fingers = false;
  std::optional<double> fingers_open_m = std::nullopt;  ///< As in RobotCommand.

 private:
  void MoveHandTo(const RigidTransform& world_from_hand, double duration_s, bool limited);
  void AdvancePose(double time_step_s);
  RobotCommand CommandOf(const JointVector& measured);
  ArmVector MostSpeed(const JointVector& measured, double hand_m_s) const;
  double CommandedSpeed(double time_step_s);

  const RobotModel* robot_;
  RigidTransform world_from_base_;
  HandControllerConfig config_;
  InverseKinematicsGoal goal_;
  JointVector reference_;
  RigidTransform target_;
  RigidTransform commanded_before_;  // world_from_tcp at the last step
  double remaining_s_ = 0;
};

}  // namespace doorforge

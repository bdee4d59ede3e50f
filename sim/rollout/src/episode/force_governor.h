// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge::internal {

/// Lets an arm's drives yield while the hand presses the door with more than a force, as a sensor
/// in its wrist would tell: the limits of the drives (DriveLimits) hold joint by joint, and several
/// joints together press with more than each of them. A step over the force takes as much of the
/// drives' share as it is over, at most half; each step below it gives a twentieth back, all of it
/// within half a second. A value.
class ForceGovernor {
 public:
  /// @param most_n Positive, or 0: nothing is governed.
  explicit ForceGovernor(double most_n) : most_n_(most_n) {}

  bool IsOn() const { return most_n_ > 0; }
  /// What the door was pressed with in a step, beyond the squeeze of the fingers [N].
  void Note(double force_n);
  /// RobotCommand::effort_share of the next step.
  double share() const { return share_; }

 private:
  double most_n_;
  double share_ = 1;
};

/// Tells when fingers that had closed on a handle have nothing between them any more, by the touch
/// of their pads. Whoever moves on then strikes leaf, frame or handle with all the momentum of arm
/// and base within one step of the physics, before any drive can yield. A value.
class GripWatch {
 public:
  /// Once a step: whether the fingers are told to be closed, and whether a pad touches the handle.
  void Note(bool closing, bool touching);
  /// For three steps at least; until a pad touches again or the fingers open.
  bool lost() const { return held_ && steps_without_ >= kStepsToLose; }

 private:
  static constexpr int kStepsToLose = 3;

  bool held_ = false;
  int steps_without_ = 0;
};

}  // namespace doorforge::internal

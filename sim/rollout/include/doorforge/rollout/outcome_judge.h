// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

/// A cause and the numbers that explain it, for people.
struct Verdict {
  EpisodeOutcome outcome = EpisodeOutcome::kDiverged;
  std::string detail;
};

/// What may keep the hand from where it was told to be.
struct Hindrance {
  double behind_m = 0;  ///< Distance of the hand's origin from its commanded pose.
  DoorContacts contacts;
  std::string joint_at_limit;  ///< JointAtLimit() gives it.
};

/// Name of the first joint of base or arm that is nearer to an end of its range than the limits'
/// margin; empty if there is none.
std::string JointAtLimit(const RobotModel& robot, const JointVector& position,
                         const EpisodeLimits& limits);

/// kCollision where the hand is behind and arm or hand press on the door, or the robot on itself,
/// by more than blocking_force_n; kJointLimit where it is behind and a joint is at its end; nothing
/// otherwise. The detail begins with a comma: it goes on from another text.
std::optional<Verdict> HeldUpBy(const Hindrance& hindrance, const EpisodeLimits& limits);

/// Why the hand, which is this far from the grasp's pose, did not get there: what holds it up, or
/// kNotReached.
Verdict JudgeReach(double hand_error_m, const Hindrance& hindrance, const EpisodeLimits& limits);

/// kGraspMissed, with what the pads touch and how far the fingers are open.
Verdict JudgeClosing(const DoorContacts& contacts, double finger_m);

/// Whether the stage "handle" is over: the handle is at its angle and the leaf is free. The sticky
/// flag WorldState::handle_done alone would not do: closing fingers may have knocked the handle
/// down for a moment. True from the start for a door without a latch.
bool IsTurned(const Latch& latch, const WorldState& state);

/// A turn of the handle that came to nothing.
struct TurnEvidence {
  double handle_rad = 0;
  double done_rad = 0;     ///< Latch::handle_done_angle_rad
  double slip_m = 0;       ///< How far the tool centre moved in the handle's frame since the grasp.
  double slip_rad = 0;     ///< How far the hand turned there.
  bool lost_pads = false;  ///< No pad touches the handle any more.
  Hindrance hindrance;
};
/// kHandleSlipped where the pads are off or the grasp has moved by more than the limits; else what
/// holds the hand up; else kHandleStuck.
Verdict JudgeTurn(const TurnEvidence& evidence, const EpisodeLimits& limits);

/// An opening that ended before the door was open with a pad on the handle.
struct OpeningEvidence {
  double hinge_rad = 0;
  int actions = 0;
  double without_pads_s = 0;  ///< Time since a pad touched the handle last.
  double slip_m = 0;          ///< It is measured as in TurnEvidence.
  bool coasted = false;       ///< The door passed the angle without a pad on the handle.
  bool lost_pads = false;     ///< For longer than an action.
  bool handle_turned = true;  ///< The stages before opening succeeded.
  bool locked = false;
  std::string early;                       ///< Said of a turn that was thought done too early.
  std::optional<Verdict> held_up_at_loss;  ///< HeldUpBy() gave it when the pads left the handle.
  Hindrance hindrance;                     ///< Now.
};
/// kGripLost where the door coasted or the pads are off, unless something held the hand up when
/// they left; kHandleStuck where it was not turned and the leaf is locked; else what holds the hand
/// up; else kDoorStuck.
Verdict JudgeOpening(const OpeningEvidence& evidence, const EpisodeLimits& limits);

}  // namespace doorforge

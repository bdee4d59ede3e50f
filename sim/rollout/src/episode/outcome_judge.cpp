// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/outcome_judge.h"

#include "text_format.h"

namespace doorforge {

using internal::Format;
using internal::kDegree;

namespace {

// `held_up` where there is one, else `otherwise`; its words go on from `detail`.
Verdict HeldUpOr(EpisodeOutcome otherwise, std::string detail,
                 const std::optional<Verdict>& held_up) {
  if (!held_up) return {otherwise, std::move(detail)};
  return {held_up->outcome, std::move(detail) + held_up->detail};
}

}  // namespace

std::string JointAtLimit(const RobotModel& robot, const JointVector& position,
                         const EpisodeLimits& limits) {
  for (int i = 0; i < robot.arm_count(); ++i) {
    const RobotJoint& joint = robot.joint(i);
    const double margin = joint.prismatic ? limits.joint_margin_m : limits.joint_margin_rad;
    const bool inside = position[i] - joint.lower > margin && joint.upper - position[i] > margin;
    if (!inside) return joint.name;
  }
  return {};
}

std::optional<Verdict> HeldUpBy(const Hindrance& hindrance, const EpisodeLimits& limits) {
  const DoorContacts& contacts = hindrance.contacts;
  if (hindrance.behind_m < limits.hand_behind_m) return std::nullopt;
  if (contacts.arm_force_n > limits.blocking_force_n)
    return Verdict{EpisodeOutcome::kCollision, ", blocked at " + contacts.arm_touches};
  if (contacts.self_force_n > limits.blocking_force_n)
    return Verdict{EpisodeOutcome::kCollision, ", blocked by itself at " + contacts.self_touches};
  if (!hindrance.joint_at_limit.empty())
    return Verdict{EpisodeOutcome::kJointLimit, ", " + hindrance.joint_at_limit + " at its limit"};
  return std::nullopt;
}

Verdict JudgeReach(double hand_error_m, const Hindrance& hindrance, const EpisodeLimits& limits) {
  return HeldUpOr(EpisodeOutcome::kNotReached,
                  Format("hand %.0f mm from the grasp pose", 1000 * hand_error_m),
                  HeldUpBy(hindrance, limits));
}

Verdict JudgeClosing(const DoorContacts& contacts, double finger_m) {
  return {EpisodeOutcome::kGraspMissed,
          Format("pads touch with %d and %d points, fingers at %.1f mm", contacts.pad_points[0],
                 contacts.pad_points[1], 1000 * finger_m)};
}

bool IsTurned(const Latch& latch, const WorldState& state) {
  if (latch.type == LatchType::kNone) return true;
  return !state.locked && state.handle_rad >= latch.handle_done_angle_rad;
}

Verdict JudgeTurn(const TurnEvidence& evidence, const EpisodeLimits& limits) {
  // the arm is stiff: if the handle alone is behind, the hand has turned on it
  const bool slipped =
      evidence.lost_pads || evidence.slip_m > limits.slip_m || evidence.slip_rad > limits.slip_rad;
  std::string detail =
      Format("handle at %.1f of %.1f deg, grasp moved %.0f mm and turned %.0f deg in it",
             evidence.handle_rad / kDegree, evidence.done_rad / kDegree, 1000 * evidence.slip_m,
             evidence.slip_rad / kDegree);
  if (slipped) return {EpisodeOutcome::kHandleSlipped, std::move(detail)};
  return HeldUpOr(EpisodeOutcome::kHandleStuck, std::move(detail),
                  HeldUpBy(evidence.hindrance, limits));
}

Verdict JudgeOpening(const OpeningEvidence& evidence, const EpisodeLimits& limits) {
  std::string detail = Format(
      "hinge at %.1f deg after %d actions, last pad contact %.2f s before the end, "
      "grasp moved %.0f mm",
      evidence.hinge_rad / kDegree, evidence.actions, evidence.without_pads_s,
      1000 * evidence.slip_m);
  const std::string& touches = evidence.hindrance.contacts.arm_touches;
  if (!touches.empty()) detail += ", arm touches " + touches;
  if (evidence.coasted)
    return {EpisodeOutcome::kGripLost, detail + Format(", the door coasted past %.0f deg by itself",
                                                       limits.open_angle_rad / kDegree)};
  if (!evidence.handle_turned) {
    detail += "; " + evidence.early;
    if (evidence.locked) return {EpisodeOutcome::kHandleStuck, std::move(detail)};
  }
  if (evidence.lost_pads)
    return HeldUpOr(EpisodeOutcome::kGripLost, std::move(detail), evidence.held_up_at_loss);
  return HeldUpOr(EpisodeOutcome::kDoorStuck, std::move(detail),
                  HeldUpBy(evidence.hindrance, limits));
}

}  // namespace doorforge

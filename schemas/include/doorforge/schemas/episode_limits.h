// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string>

namespace doorforge {

/// Thresholds that say how an episode ends, and the numbers by which its rules move the arm until
/// the fingers hold the handle and the latch is free. The defaults are those of every published
/// figure; another value changes outcomes, so a scene's record names it.
struct EpisodeLimits {
  // ---- what an outcome is judged by
  double open_angle_rad = 45 * (std::numbers::pi / 180);  ///< From here on the door is open.
  /// 1: the door is opened by a hand with a pad on the handle; 0: by whatever it is past the angle,
  /// as others judge who have no latch to turn.
  int grip_needed = 1;
  double blocking_force_n = 50;      ///< A greater force on arm or hand is a collision.
  double hand_behind_m = 0.01;       ///< A hand this far behind its commanded pose is held up.
  double joint_margin_rad = 0.01;    ///< A turning joint this near to its end is at its limit.
  double joint_margin_m = 0.003;     ///< A slider this near to its end is at its limit.
  double slip_m = 0.025;             ///< A grasp that moved farther along the handle has slipped.
  double slip_rad = 0.125;           ///< A grasp that turned farther on the handle has slipped.
  double reach_tolerance_m = 0.012;  ///< The hand has arrived at a grasp this near to it.
  double both_pads_time_s = 0.12;    ///< Touch of both pads for this long is a grasp.
  double lost_time_s = 0.25;         ///< A turn by rule ends after this long without any pad.
  int off_handle_actions = 3;  ///< A policy's turn ends after this many actions without any pad.
  int off_door_actions = 6;    ///< Opening ends after this many actions without touching the door.
  // ---- how the arm gets there
  double farthest_move_m = 10;  ///< No arm gets there, and the way would take hours.
  double reach_time_s = 4;      ///< Longest motion of the joints to the place before the grasp.
  double reach_speed_fraction = 0.6;  ///< Share of the joints' velocity limits in that motion.
  double approach_speed_m_s = 0.15;   ///< From there to the grasp.
  double close_time_s = 1.2;          ///< Longest closing of the fingers.
  double centering_speed_m_s =
      0.05;  ///< A hand that follows the finger that touches first is so fast.
  // ---- how the rule turns the handle
  double turn_speed_rad_s = 0.8;
  double turn_lead_rad = 0.25;    ///< Most that the commanded handle is ahead of the measured one.
  double turn_beyond_rad = 0.07;  ///< The rule aims this far past "handle done".
  double turn_time_s = 4;         ///< Longest turn.

  bool operator==(const EpisodeLimits&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("open_angle_rad", self.open_angle_rad);
    visit("grip_needed", self.grip_needed);
    visit("blocking_force_n", self.blocking_force_n);
    visit("hand_behind_m", self.hand_behind_m);
    visit("joint_margin_rad", self.joint_margin_rad);
    visit("joint_margin_m", self.joint_margin_m);
    visit("slip_m", self.slip_m);
    visit("slip_rad", self.slip_rad);
    visit("reach_tolerance_m", self.reach_tolerance_m);
    visit("both_pads_time_s", self.both_pads_time_s);
    visit("lost_time_s", self.lost_time_s);
    visit("off_handle_actions", self.off_handle_actions);
    visit("off_door_actions", self.off_door_actions);
    visit("farthest_move_m", self.farthest_move_m);
    visit("reach_time_s", self.reach_time_s);
    visit("reach_speed_fraction", self.reach_speed_fraction);
    visit("approach_speed_m_s", self.approach_speed_m_s);
    visit("close_time_s", self.close_time_s);
    visit("centering_speed_m_s", self.centering_speed_m_s);
    visit("turn_speed_rad_s", self.turn_speed_rad_s);
    visit("turn_lead_rad", self.turn_lead_rad);
    visit("turn_beyond_rad", self.turn_beyond_rad);
    visit("turn_time_s", self.turn_time_s);
  }
};

/// Throws Error(kInvalidConfig) that names the first field of `path` that is out of its range.
void CheckEpisodeLimits(const EpisodeLimits& limits, const std::string& path);

}  // namespace doorforge

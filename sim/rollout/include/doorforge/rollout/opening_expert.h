// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/policy.h"

namespace doorforge {

struct OpeningExpertConfig {
  double step_m = 0.055;         ///< Arc that the hand is led ahead by one action.
  double least_turn_rad = 0.05;  ///< Wide doors get a longer arc, so that 25 actions are enough.
  double first_step_m = 0.02;    ///< The first action goes so far; it grows to step_m over four.
  /// The handle stays turned, pressed this much beyond its angle, until the door is ajar; to the
  /// end where it would lock the open door, see DoorFacts::relatches.
  double press_rad = 0.25;
  double ajar_rad = 0.0873;             ///< 5 degrees.
  double relax_rad_per_action = 0.133;  ///< 0.8 rad/s.
  /// So much of a pushed door's turn the hand does not follow, so that the arm behind
  /// it comes through the doorway instead of against the jamb; its pads turn on the handle.
  double push_yaw_share = 0.92;
  double tool_m = 0.1034;  ///< From the hand's frame to the middle of the pads, along its z.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("step_m", self.step_m);
    visit("least_turn_rad", self.least_turn_rad);
    visit("first_step_m", self.first_step_m);
    visit("press_rad", self.press_rad);
    visit("ajar_rad", self.ajar_rad);
    visit("relax_rad_per_action", self.relax_rad_per_action);
    visit("push_yaw_share", self.push_yaw_share);
    visit("tool_m", self.tool_m);
  }
};

/// Opens the door by replaying the grasp on the true arc of the measured hinge: the target leads
/// the measured angle, so a door that is stuck does not wind it up. Pushing, that is where the door
/// goes the way the hand points, the hand keeps its heading and the pads turn on the handle. Reads
/// only the privileged state.
class OpeningExpert : public Policy {
 public:
  explicit OpeningExpert(const OpeningExpertConfig& config = {}) : config_(config) {}

  void Reset() override;
  Action Act(const Observation& observation) override;
  bool UsesPointCloud() const override { return false; }

 private:
  OpeningExpertConfig config_;
  int actions_ = 0;
  bool pushes_ = false;
  double handle_target_rad_ = 0;
  RigidTransform handle_from_hand_ = RigidTransform::Identity();
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/policy.h"

namespace doorforge {

struct HandleExpertConfig {
  /// How far the hand is led ahead of the measured handle by one action; a handle that is stuck
  /// does not wind it up. UniDoorManip's rules: 20 to 25 degrees on knobs, 6 cm on levers.
  double step_rad = 0.2;
  double first_step_rad = 0.1;  ///< The first action goes so far: the grasp still settles.
  double most_slip_rad = 0.4;   ///< The hand may get ahead of what it holds by so much.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("step_rad", self.step_rad);
    visit("first_step_rad", self.first_step_rad);
    visit("most_slip_rad", self.most_slip_rad);
  }
};

/// Turns the handle as UniDoorManip's rules do (its released code), decision by
/// decision: the hand as it holds the handle goes round the handle's axis. Reads only the
/// privileged state.
class HandleExpert : public Policy {
 public:
  explicit HandleExpert(const HandleExpertConfig& config = {}) : config_(config) {}

  void Reset() override { actions_ = 0; }
  Action Act(const Observation& observation) override;
  bool UsesPointCloud() const override { return false; }

 private:
  HandleExpertConfig config_;
  int actions_ = 0;
  RigidTransform handle_from_hand_ = RigidTransform::Identity();
};

}  // namespace doorforge

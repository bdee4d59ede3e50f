// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/schemas/grasp_policy.h"

namespace doorforge {

/// How contact points and orientations are sampled for the grasp stage.
struct RandomGraspConfig {
  /// Share of orientations near the handle's own grasp; the others take any turn about the
  /// approach. Uniform turns alone fail so often that a learner would see hardly any door open.
  double near_share = 0.5;
  double near_turn_rad = 0.26;  ///< Standard deviation of the turn near the handle's own grasp.
  double tilt_rad = 0.1;        ///< Standard deviation of the approach about both its normals.
  /// Share of contact points that are near the handle without being on it.
  double beside_share = 0.1;
  double beside_m = 0.03;  ///< Largest distance from the box around the handle's visible points.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("near_share", self.near_share);
    visit("near_turn_rad", self.near_turn_rad);
    visit("tilt_rad", self.tilt_rad);
    visit("beside_share", self.beside_share);
    visit("beside_m", self.beside_m);
  }
};

/// Samples grasps for the grasp stage (UniDoorManip, Section 4 and released code): a visible point
/// of the handle, each as likely as any other, and a hand turned about its approach, which on all
/// handles but flaps is the handle's axis, so that the fingers close in the plane normal to it. The
/// random stream is "grasp/<door id>/<episode>" of the scene's seed.
class RandomGraspPolicy : public GraspPolicy {
 public:
  /// @throws Error(kInvalidConfig) on a share out of [0, 1] or a spread below 0.
  explicit RandomGraspPolicy(const RandomGraspConfig& config = {});

  /// The action has no cloud.
  std::optional<GraspAction> Choose(const GraspObservation& observation) override;

 private:
  RandomGraspConfig config_;
};

/// Throws Error(kInvalidConfig) as the constructor.
void CheckRandomGrasp(const RandomGraspConfig& config);

}  // namespace doorforge

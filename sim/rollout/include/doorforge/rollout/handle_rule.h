// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Turns the handle in one go: says at every step of the physics where the hand is to be, where a
/// Policy decides every 1/6 s. One instance serves one episode at a time.
class HandleRule {
 public:
  virtual ~HandleRule() = default;
  /// Called once before an episode's first Follow().
  virtual void Reset(const PrivilegedState& now) = 0;
  /// world_from_hand for the next step of the physics.
  virtual RigidTransform Follow(const PrivilegedState& now) = 0;
};

/// The hand as it held the handle when the fingers had closed goes round the handle's axis, at
/// EpisodeLimits::turn_speed_rad_s, ahead of the measured handle by turn_lead_rad at most: a handle
/// that is stuck does not wind the arm up. It aims turn_beyond_rad past "handle done".
class ExpertUnlock : public HandleRule {
 public:
  /// @param scene, door Must outlive this.
  ExpertUnlock(const Scene& scene, const DoorAsset& door) : scene_(scene), door_(door) {}

  void Reset(const PrivilegedState& now) override { commanded_rad_ = now.handle_rad; }
  RigidTransform Follow(const PrivilegedState& now) override;

 private:
  const Scene& scene_;
  const DoorAsset& door_;
  double commanded_rad_ = 0;
};

}  // namespace doorforge

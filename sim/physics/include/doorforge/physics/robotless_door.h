// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/physics/latch_law.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// A door in a world of its own, without a robot: the same bodies, latch law, bolt and damping as
/// DoorWorld has, gravity off, no contacts but those of bolt and strike. Closed and at rest at the
/// beginning. Any side and opening; deterministic.
class RobotlessDoor {
 public:
  /// @param door Must outlive this.
  /// @throws Error(kInvalidArgument) as RequireSimulatable() and BoltOf(), for a moving link
  ///     without mass, or a hull of fewer than four points.
  explicit RobotlessDoor(const DoorAsset& door, double time_step_s = 1.0 / 240);
  ~RobotlessDoor();
  RobotlessDoor(RobotlessDoor&&) noexcept;
  RobotlessDoor& operator=(RobotlessDoor&&) noexcept;

  /// Advances by one step under torques of a hand, besides those of latch, springs and damping
  /// [N m]; positive ones open and unlock.
  void Step(double hinge_nm, double handle_nm);

  double hinge_rad() const;
  double hinge_rad_s() const;
  double handle_rad() const;
  double handle_rad_s() const;
  double bolt_m() const;  ///< It means what WorldState::bolt_m does.
  const LatchState& latch() const;

  /// False once an angle is not finite, or a joint turns faster than 90 rad/s.
  bool Finite() const;

 private:
  class Runtime;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace doorforge

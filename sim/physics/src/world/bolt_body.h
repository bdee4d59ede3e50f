// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "doorforge/schemas/bolt.h"

#include "collision/bullet_body.h"

namespace doorforge::internal {

/// The links of a door that its bolt knows.
struct BoltLinks {
  int handle = 0;
  int bolt = 0;
};

/// A door's bolt at work: what draws it back, what pushes it out, and the strike that it meets.
class BoltBody {
 public:
  /// @param door The multibody that has LinkOf() among its links; must outlive this.
  BoltBody(btMultiBodyDynamicsWorld& world, BulletBody& door, const Bolt& bolt,
           const BoltLinks& links);
  ~BoltBody();
  BoltBody(const BoltBody&) = delete;
  BoltBody& operator=(const BoltBody&) = delete;

  static BulletLink LinkOf(const Bolt& bolt, int leaf);

  /// Puts the strike beside the door. Before the first step.
  void PlaceStrike(const RigidTransform& world_from_door);
  /// The spring's force for the next step. Before each step.
  void ApplySpring(double time_step_s);

  double position_m() const { return door_.Position(links_.bolt); }
  double velocity_m_s() const { return door_.Velocity(links_.bolt); }
  const Bolt& description() const { return bolt_; }

 private:
  btMultiBodyDynamicsWorld& world_;
  BulletBody& door_;
  Bolt bolt_;
  BoltLinks links_;
  std::unique_ptr<btCollisionShape> strike_shape_;
  std::unique_ptr<btCollisionObject> strike_ = std::make_unique<btCollisionObject>();
};

}  // namespace doorforge::internal

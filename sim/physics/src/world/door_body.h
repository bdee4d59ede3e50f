// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "doorforge/physics/latch_law.h"
#include "doorforge/schemas/door_asset.h"

#include "collision/bullet_body.h"
#include "world/bolt_body.h"

namespace doorforge::internal {

/// Bullet times its own functions in global tables, which are not made for several worlds at once.
void SwitchProfilingOff();

/// A door in a world: frame, leaf, handle, bolt where the latch is one, and what acts on the joints
/// by itself. Closed and at rest at the beginning.
class DoorBody {
 public:
  /// @param door Must outlive this; its own latch is not looked at.
  DoorBody(btMultiBodyDynamicsWorld& world, const RigidTransform& world_from_door,
           const DoorAsset& door, const Latch& latch, double handle_friction);
  ~DoorBody();
  DoorBody(const DoorBody&) = delete;
  DoorBody& operator=(const DoorBody&) = delete;

  /// Torques of latch, springs and damping for the next step, and these besides [N m]. To be called
  /// before each step.
  void ApplyTorques(double hinge_nm, double handle_nm, double time_step_s);
  /// To be called after each step.
  void UpdateLatch();

  BulletBody& body() { return body_; }
  double hinge_rad() const { return body_.Position(kHinge); }
  double hinge_rad_s() const { return body_.Velocity(kHinge); }
  double handle_rad() const { return body_.Position(kHandle); }
  double handle_rad_s() const { return body_.Velocity(kHandle); }
  const LatchState& latch() const { return state_; }
  void RestoreLatch(const LatchState& state) { state_ = state; }
  bool HasBolt() const { return bolt_ != nullptr; }
  double bolt_m() const { return bolt_ ? bolt_->position_m() : 0; }
  double bolt_m_s() const { return bolt_ ? bolt_->velocity_m_s() : 0; }

  const btCollisionObject* handle_collider() const { return body_.collider(kHandle); }
  const btCollisionObject* leaf_collider() const { return body_.collider(kHinge); }

 private:
  static constexpr int kHinge = 0;
  static constexpr int kHandle = 1;
  static constexpr int kBolt = 2;

  static std::optional<Bolt> MakeBolt(const DoorAsset& door, const Latch& latch);
  static std::vector<BulletLink> LinksOf(const DoorAsset& door, double handle_friction,
                                         const std::optional<Bolt>& bolt);
  void AddFrame(const RigidTransform& world_from_door);
  void Turn(int link, double torque_nm);

  btMultiBodyDynamicsWorld& world_;
  const DoorAsset& door_;
  Latch latch_;
  LatchState state_;
  std::optional<Bolt> described_bolt_;
  BulletBody body_;
  double hinge_inertia_ = 0;   // about the joint's axis, as the multibody has it [kg m^2]
  double handle_inertia_ = 0;  // the same
  // Bullet's objects are allocated, so that they lie in the world's BulletMemory.
  std::unique_ptr<btCompoundShape> frame_shape_ = std::make_unique<btCompoundShape>();
  std::vector<std::unique_ptr<btCollisionShape>> frame_hulls_;
  std::unique_ptr<btCollisionObject> frame_ = std::make_unique<btCollisionObject>();
  std::unique_ptr<BoltBody> bolt_;
};

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/door_body.h"

#include <algorithm>
#include <mutex>

#include <LinearMath/btQuickprof.h>

#include "world/door_inertia.h"

namespace doorforge::internal {
namespace {

std::vector<TriangleMesh> HullsOf(const DoorLink& link) {
  std::vector<TriangleMesh> hulls;
  for (const DoorGeometry& geometry : link.geometry)
    hulls.insert(hulls.end(), geometry.hulls.begin(), geometry.hulls.end());
  return hulls;
}

BulletLink DoorBulletLink(const DoorJoint& joint, const DoorLink& link) {
  BulletLink result;
  const bool turns = joint.upper_rad > joint.lower_rad;
  result.joint = turns ? BulletJoint::kRevolute : BulletJoint::kFixed;
  result.parent_from_joint = joint.parent_from_child_at_zero;
  result.axis = joint.axis;
  result.lower = joint.lower_rad;
  result.upper = joint.upper_rad;
  result.mass = link.mass;
  result.hulls = HullsOf(link);
  return result;
}

// Viscous torque that one explicit step cannot turn into acceleration.
double DampingTorque(double damping, double velocity, double inertia, double time_step) {
  return -std::min(damping, 0.5 * inertia / time_step) * velocity;
}

}  // namespace

void SwitchProfilingOff() {
  static std::once_flag once;
  std::call_once(once, [] {
    btSetCustomEnterProfileZoneFunc([](const char*) {});
    btSetCustomLeaveProfileZoneFunc([] {});
  });
}

DoorBody::DoorBody(btMultiBodyDynamicsWorld& world, const RigidTransform& world_from_door,
                   const DoorAsset& door, const Latch& latch, double handle_friction)
    : world_(world),
      door_(door),
      latch_(latch),
      described_bolt_(MakeBolt(door, latch)),
      body_(world, world_from_door, LinksOf(door, handle_friction, described_bolt_),
            ContactSide::kDoor),
      hinge_inertia_(InertiaAbout(door.hinge, door.links[kLeafLink].mass, kLeastLeafInertia)),
      handle_inertia_(
          InertiaAbout(door.handle_joint, door.links[kHandleLink].mass, kLeastHandleInertia)) {
  AddFrame(world_from_door);
  if (described_bolt_) {
    bolt_ = std::make_unique<BoltBody>(world, body_, *described_bolt_, BoltLinks{kHandle, kBolt});
    bolt_->PlaceStrike(world_from_door);
  }
  body_.SyncColliders();
  UpdateLatch();
}

DoorBody::~DoorBody() {
  if (!frame_hulls_.empty()) world_.removeCollisionObject(frame_.get());
}

std::optional<Bolt> DoorBody::MakeBolt(const DoorAsset& door, const Latch& latch) {
  if (latch.type != LatchType::kBolt) return std::nullopt;
  DoorAsset latched = door;
  latched.latch = latch;
  return BoltOf(latched);
}

std::vector<BulletLink> DoorBody::LinksOf(const DoorAsset& door, double handle_friction,
                                          const std::optional<Bolt>& bolt) {
  BulletLink leaf = DoorBulletLink(door.hinge, door.links[kLeafLink]);
  leaf.least_inertia_kg_m2 = kLeastLeafInertia;
  BulletLink handle = DoorBulletLink(door.handle_joint, door.links[kHandleLink]);
  handle.parent = kHinge;
  handle.least_inertia_kg_m2 = kLeastHandleInertia;
  handle.friction = handle_friction;
  if (!bolt) return {leaf, handle};
  return {leaf, handle, BoltBody::LinkOf(*bolt, kHinge)};
}

void DoorBody::AddFrame(const RigidTransform& world_from_door) {
  for (const TriangleMesh& mesh : HullsOf(door_.links[kBaseLink])) {
    frame_hulls_.push_back(MakeHull(mesh, RigidTransform::Identity()));
    frame_shape_->addChildShape(btTransform::getIdentity(), frame_hulls_.back().get());
  }
  if (frame_hulls_.empty()) return;
  frame_->setCollisionShape(frame_shape_.get());
  frame_->setWorldTransform(ToBullet(world_from_door));
  frame_->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  world_.addCollisionObject(frame_.get(), static_cast<int>(ContactSide::kDoor),
                            static_cast<int>(ContactSide::kRobot));
}

void DoorBody::ApplyTorques(double hinge_nm, double handle_nm, double time_step_s) {
  const LatchTorques law = TorquesOf(latch_, state_, hinge_rad(), handle_rad());
  Turn(kHinge,
       law.hinge_nm + hinge_nm +
           DampingTorque(door_.hinge.damping_nm_s, hinge_rad_s(), hinge_inertia_, time_step_s));
  Turn(kHandle, law.handle_nm + handle_nm +
                    DampingTorque(door_.handle_joint.damping_nm_s, handle_rad_s(), handle_inertia_,
                                  time_step_s));
  if (bolt_) bolt_->ApplySpring(time_step_s);
}

// Bullet forgets joint torques after each step.
void DoorBody::Turn(int link, double torque_nm) {
  if (body_.multibody().getLink(link).m_dofCount > 0)
    body_.multibody().addJointTorque(link, torque_nm);
}

void DoorBody::UpdateLatch() {
  state_ = UpdatedLatch(latch_, state_, hinge_rad(), handle_rad());
  if (bolt_) state_.locked = IsCaught(*described_bolt_, door_, hinge_rad(), bolt_->position_m());
}

}  // namespace doorforge::internal

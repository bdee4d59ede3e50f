// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

btVector3 ToBullet(const Eigen::Vector3d& v);
btTransform ToBullet(const RigidTransform& transform);

enum class BulletJoint { kFixed, kRevolute, kPrismatic };

/// Which side of the contact filter a body is on: robot and door collide, bolt and strike do, and
/// the robot with itself as a SelfCollisionFilter says.
enum class ContactSide : int { kRobot = 2, kDoor = 4, kBolt = 8, kStrike = 16 };

/// The sides that a side collides with, for Bullet.
int MaskOf(ContactSide side);

/// What Bullet keeps around every hull [m]; its default is 4 cm.
inline constexpr double kHullMargin = 0.001;

/// A link of a multibody as this project describes it; the frame is the joint's after the motion.
struct BulletLink {
  BulletJoint joint = BulletJoint::kRevolute;
  int parent = -1;
  RigidTransform parent_from_joint = RigidTransform::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double lower = 0;
  double upper = 0;
  MassProperties mass;
  /// Principal moments below this are raised to it: light links in front of heavy ones make the
  /// contact solver converge badly.
  double least_inertia_kg_m2 = 0;
  std::vector<TriangleMesh> hulls;
  double hull_margin_m = kHullMargin;
  double friction = 0.5;
  std::optional<ContactSide> side;  ///< Where it is not that of the body.
};

/// A multibody with colliders on a fixed base, and all that Bullet wants to be kept alive for it.
class BulletBody {
 public:
  BulletBody(btMultiBodyDynamicsWorld& world, const RigidTransform& world_from_base,
             const std::vector<BulletLink>& links, ContactSide side);
  ~BulletBody();
  BulletBody(const BulletBody&) = delete;
  BulletBody& operator=(const BulletBody&) = delete;

  btMultiBody& multibody() { return *multibody_; }
  const btMultiBody& multibody() const { return *multibody_; }
  const btCollisionObject* collider(int link) const {
    return colliders_[static_cast<std::size_t>(link)].get();
  }

  /// Takes a constraint of this body into the world.
  template <class Constraint>
  Constraint& Add(std::unique_ptr<Constraint> constraint) {
    Constraint& added = *constraint;
    world_.addMultiBodyConstraint(constraint.get());
    constraints_.push_back(std::move(constraint));
    return added;
  }

  /// Call after joint positions were set: colliders start at the origin otherwise.
  void SyncColliders();

  int link_count() const { return multibody_->getNumLinks(); }
  double Position(int link) const;
  double Velocity(int link) const;
  /// Acts on the joint in the next step, as far as it is set by now; drives are not in it.
  double AppliedTorque(int link) const;
  /// SyncColliders() has to follow.
  void PlaceJoint(int link, double position, double velocity);
  /// Adds up all links [J].
  double KineticEnergy() const;

 private:
  std::unique_ptr<btCollisionShape> MakeShape(const BulletLink& link,
                                              const RigidTransform& link_from_joint);
  void AddCollider(int index, const BulletLink& link, const RigidTransform& link_from_joint,
                   ContactSide side);

  btMultiBodyDynamicsWorld& world_;
  std::unique_ptr<btMultiBody> multibody_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
};

/// Mass as the links of a multibody have it: no principal moment below the least one.
MassProperties WithLeastInertia(MassProperties mass, double least_kg_m2);

/// A hull as Bullet holds it.
std::unique_ptr<btCollisionShape> MakeHull(const TriangleMesh& mesh,
                                           const RigidTransform& link_from_mesh,
                                           double margin_m = kHullMargin);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/bullet_body.h"

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <Eigen/Eigenvalues>

#include "doorforge/core/error.h"

#include "collision/joint_stop.h"

namespace doorforge::internal {
namespace {

// Bullet wants inertia along the axes of the link's frame, at the centre of mass: so its frame is
// the principal one.
RigidTransform JointFromPrincipal(const MassProperties& mass, Eigen::Vector3d& moments) {
  RigidTransform joint_from_principal = Translation(mass.center_of_mass_m);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia_kg_m2);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  joint_from_principal.linear() = axes;
  moments = solver.eigenvalues();
  return joint_from_principal;
}

btQuaternion ToBullet(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace

btVector3 ToBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

btTransform ToBullet(const RigidTransform& transform) {
  return btTransform(ToBullet(Eigen::Matrix3d(transform.linear())),
                     ToBullet(Eigen::Vector3d(transform.translation())));
}

int MaskOf(ContactSide side) {
  switch (side) {
    case ContactSide::kRobot:
      return static_cast<int>(ContactSide::kDoor) | static_cast<int>(ContactSide::kRobot);
    case ContactSide::kDoor:
      return static_cast<int>(ContactSide::kRobot);
    case ContactSide::kBolt:
      return static_cast<int>(ContactSide::kStrike);
    case ContactSide::kStrike:
      return static_cast<int>(ContactSide::kBolt);
  }
  return 0;
}

std::unique_ptr<btCollisionShape> MakeHull(const TriangleMesh& mesh,
                                           const RigidTransform& link_from_mesh, double margin_m) {
  Require(mesh.vertices.size() >= 4, ErrorCode::kInvalidArgument,
          "a collision hull has fewer than four points; run `doorforge validate` on the door");
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    hull->addPoint(ToBullet(Eigen::Vector3d(link_from_mesh * vertex)), false);
  hull->setMargin(margin_m);
  hull->recalcLocalAabb();
  return hull;
}

MassProperties WithLeastInertia(MassProperties mass, double least_kg_m2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia_kg_m2);
  mass.inertia_kg_m2 = solver.eigenvectors() *
                       solver.eigenvalues().cwiseMax(least_kg_m2).asDiagonal() *
                       solver.eigenvectors().transpose();
  return mass;
}

BulletBody::BulletBody(btMultiBodyDynamicsWorld& world, const RigidTransform& world_from_base,
                       const std::vector<BulletLink>& links, ContactSide side)
    : world_(world) {
  const int count = static_cast<int>(links.size());
  multibody_ = std::make_unique<btMultiBody>(count, 0, btVector3(0, 0, 0), true, false);
  multibody_->setBaseWorldTransform(ToBullet(world_from_base));

  std::vector<RigidTransform> joint_from_link;
  for (int i = 0; i < count; ++i) {
    const BulletLink& link = links[static_cast<std::size_t>(i)];
    Require(link.mass.mass_kg > 0, ErrorCode::kInvalidArgument,
            "a moving link has no mass; run `doorforge validate` on the door");
    Eigen::Vector3d moments;
    joint_from_link.push_back(JointFromPrincipal(link.mass, moments));
    moments = moments.cwiseMax(link.least_inertia_kg_m2);

    const RigidTransform parent_joint_from_link =
        link.parent < 0 ? RigidTransform::Identity()
                        : joint_from_link[static_cast<std::size_t>(link.parent)];
    const RigidTransform& to_principal = joint_from_link.back();
    const RigidTransform parent_from_joint =
        parent_joint_from_link.inverse() * link.parent_from_joint;
    const Eigen::Matrix3d parent_from_link = parent_from_joint.linear() * to_principal.linear();
    const btQuaternion link_from_parent = ToBullet(Eigen::Matrix3d(parent_from_link.transpose()));
    const btVector3 axis = ToBullet(Eigen::Vector3d(to_principal.linear().transpose() * link.axis));
    const btVector3 pivot = ToBullet(Eigen::Vector3d(parent_from_joint.translation()));
    const btVector3 center =
        ToBullet(Eigen::Vector3d(to_principal.linear().transpose() * to_principal.translation()));
    const btVector3 inertia = ToBullet(moments);
    if (link.joint == BulletJoint::kRevolute) {
      multibody_->setupRevolute(i, link.mass.mass_kg, inertia, link.parent, link_from_parent, axis,
                                pivot, center, true);
    } else if (link.joint == BulletJoint::kPrismatic) {
      multibody_->setupPrismatic(i, link.mass.mass_kg, inertia, link.parent, link_from_parent, axis,
                                 pivot, center, true);
    } else {
      multibody_->setupFixed(i, link.mass.mass_kg, inertia, link.parent, link_from_parent, pivot,
                             center);
    }
  }
  multibody_->finalizeMultiDof();
  multibody_->setCanSleep(false);
  multibody_->setHasSelfCollision(side == ContactSide::kRobot);
  multibody_->setLinearDamping(0);
  multibody_->setAngularDamping(0);
  multibody_->setMaxAppliedImpulse(1000);
  multibody_->setMaxCoordinateVelocity(100);
  world_.addMultiBody(multibody_.get());

  for (int i = 0; i < count; ++i) {
    const BulletLink& link = links[static_cast<std::size_t>(i)];
    AddCollider(i, link, joint_from_link[static_cast<std::size_t>(i)].inverse(), side);
    if (link.joint != BulletJoint::kFixed)
      Add(std::make_unique<JointStop>(multibody_.get(), i, link.lower, link.upper));
  }
}

BulletBody::~BulletBody() {
  for (const auto& constraint : constraints_) world_.removeMultiBodyConstraint(constraint.get());
  world_.removeMultiBody(multibody_.get());
  for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
}

std::unique_ptr<btCollisionShape> BulletBody::MakeShape(const BulletLink& link,
                                                        const RigidTransform& link_from_joint) {
  // A link without a collider has no island, and Bullet then silently skips its motors and limits.
  // The sphere's contact mask is empty.
  if (link.hulls.empty()) return std::make_unique<btSphereShape>(0.001);
  if (link.hulls.size() == 1) return MakeHull(link.hulls[0], link_from_joint, link.hull_margin_m);
  auto compound = std::make_unique<btCompoundShape>();
  for (const TriangleMesh& mesh : link.hulls) {
    shapes_.push_back(MakeHull(mesh, link_from_joint, link.hull_margin_m));
    compound->addChildShape(btTransform::getIdentity(), shapes_.back().get());
  }
  return compound;
}

void BulletBody::AddCollider(int index, const BulletLink& link,
                             const RigidTransform& link_from_joint, ContactSide side) {
  shapes_.push_back(MakeShape(link, link_from_joint));
  auto collider = std::make_unique<btMultiBodyLinkCollider>(multibody_.get(), index);
  collider->setCollisionShape(shapes_.back().get());
  collider->setFriction(link.friction);
  // Rolling friction is a length in Bullet: any value that looks like a coefficient welds a knob.
  collider->setRollingFriction(0);
  collider->setSpinningFriction(0);
  collider->setActivationState(DISABLE_DEACTIVATION);
  multibody_->getLink(index).m_collider = collider.get();
  const ContactSide own = link.side.value_or(side);
  const int mask = link.hulls.empty() ? 0 : MaskOf(own);
  world_.addCollisionObject(collider.get(), static_cast<int>(own), mask);
  colliders_.push_back(std::move(collider));
}

void BulletBody::SyncColliders() {
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> positions;
  multibody_->forwardKinematics(rotations, positions);
  multibody_->updateCollisionObjectWorldTransforms(rotations, positions);
}

double BulletBody::Position(int link) const {
  return multibody_->getLink(link).m_dofCount == 0 ? 0 : multibody_->getJointPos(link);
}

double BulletBody::Velocity(int link) const {
  return multibody_->getLink(link).m_dofCount == 0 ? 0 : multibody_->getJointVel(link);
}

double BulletBody::AppliedTorque(int link) const {
  return multibody_->getLink(link).m_dofCount == 0 ? 0 : multibody_->getJointTorque(link);
}

void BulletBody::PlaceJoint(int link, double position, double velocity) {
  if (multibody_->getLink(link).m_dofCount == 0) return;
  multibody_->setJointPos(link, position);
  multibody_->setJointVel(link, velocity);
}

double BulletBody::KineticEnergy() const {
  const auto frames = static_cast<std::size_t>(link_count()) + 1;
  std::vector<btVector3> turn(frames);
  std::vector<btVector3> motion(frames);
  multibody_->compTreeLinkVelocities(turn.data(), motion.data());
  double energy = 0;
  for (int i = 0; i < link_count(); ++i) {
    // in the link's frame, which is the principal one
    const btMultibodyLink& link = multibody_->getLink(i);
    const btVector3& spin = turn[static_cast<std::size_t>(i) + 1];
    energy += link.m_mass * motion[static_cast<std::size_t>(i) + 1].length2() / 2 +
              (link.m_inertiaLocal * spin).dot(spin) / 2;
  }
  return energy;
}

}  // namespace doorforge::internal

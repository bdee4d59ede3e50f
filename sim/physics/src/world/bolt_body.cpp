// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/bolt_body.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

// In front of hulls a few millimetres wide the usual one would hide their shape.
constexpr double kBoltMargin = 1e-4;
constexpr double kMostImpulse = 1000;  // [N s]

/// Keeps the bolt at least as far back as the handle draws it: one row, which only pulls.
class Pull : public btMultiBodyConstraint {
 public:
  Pull(btMultiBody& door, const BoltLinks& links, const Bolt& bolt)
      : btMultiBodyConstraint(&door, &door, links.bolt, links.handle, 1, true,
                              MULTIBODY_CONSTRAINT_GEAR),
        links_(links),
        throw_m_(bolt.throw_m),
        travel_m_per_rad_(bolt.travel_m_per_rad) {
    m_maxAppliedImpulse = kMostImpulse;
  }

  void finalizeMultiDof() override {
    allocateJacobiansMultiDof();
    m_numDofsFinalized = m_jacSizeBoth;
  }

  int getIslandIdA() const override { return Island(links_.bolt); }
  int getIslandIdB() const override { return Island(links_.handle); }

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override {
    if (m_numDofsFinalized != m_jacSizeBoth) finalizeMultiDof();
    const double wanted = travel_m_per_rad_ * m_bodyA->getJointPos(links_.handle);
    const bool follows = wanted < throw_m_;
    const double slack = -std::min(wanted, throw_m_) - m_bodyA->getJointPos(links_.bolt);
    // both joints are of one body, so they share its row of the Jacobian
    std::fill_n(jacobianA(0), m_jacSizeBoth, 0.0);
    jacobianA(0)[6 + m_bodyA->getLink(links_.bolt).m_dofOffset] = -1;
    if (follows) jacobianA(0)[6 + m_bodyA->getLink(links_.handle).m_dofOffset] = -travel_m_per_rad_;
    const double least_speed = -slack * (slack > 0 ? 1 : info.m_erp2) / info.m_timeStep;
    btMultiBodySolverConstraint& row = rows.expandNonInitializing();
    row.m_orgConstraint = this;
    row.m_orgDofIndex = 0;
    row.m_contactNormal1.setZero();
    row.m_contactNormal2.setZero();
    row.m_relpos1CrossNormal.setZero();
    row.m_relpos2CrossNormal.setZero();
    row.m_multiBodyA = m_bodyA;
    row.m_multiBodyB = m_bodyB;
    const btVector3 none(0, 0, 0);
    fillMultiBodyConstraint(row, data, jacobianA(0), jacobianB(0), none, none, none, none, 0, info,
                            0, kMostImpulse, false, 1, false, least_speed);
  }

  void debugDraw(btIDebugDraw* /*drawer*/) override {}

 private:
  int Island(int link) const { return m_bodyA->getLink(link).m_collider->getIslandTag(); }

  BoltLinks links_;
  double throw_m_;
  double travel_m_per_rad_;
};

}  // namespace

BulletLink BoltBody::LinkOf(const Bolt& bolt, int leaf) {
  BulletLink link;
  link.joint = BulletJoint::kPrismatic;
  link.parent = leaf;
  link.parent_from_joint = bolt.leaf_from_bolt;
  link.axis = Eigen::Vector3d::UnitY();
  link.lower = -bolt.travel_m;
  link.upper = 0;
  link.mass.mass_kg = bolt.mass_kg;
  link.mass.inertia_kg_m2 = Eigen::Matrix3d::Identity() * 1e-5;
  link.hulls = {bolt.bolt_hull};
  link.hull_margin_m = kBoltMargin;
  link.friction = bolt.friction;
  link.side = ContactSide::kBolt;
  return link;
}

BoltBody::BoltBody(btMultiBodyDynamicsWorld& world, BulletBody& door, const Bolt& bolt,
                   const BoltLinks& links)
    : world_(world), door_(door), bolt_(bolt), links_(links) {
  door.Add(std::make_unique<Pull>(door.multibody(), links, bolt_));
}

BoltBody::~BoltBody() {
  if (strike_shape_) world_.removeCollisionObject(strike_.get());
}

void BoltBody::PlaceStrike(const RigidTransform& world_from_door) {
  strike_shape_ = MakeHull(bolt_.strike_hull, RigidTransform::Identity(), kBoltMargin);
  strike_->setCollisionShape(strike_shape_.get());
  strike_->setWorldTransform(ToBullet(world_from_door * bolt_.base_from_strike));
  strike_->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  strike_->setFriction(1);
  world_.addCollisionObject(strike_.get(), static_cast<int>(ContactSide::kStrike),
                            MaskOf(ContactSide::kStrike));
}

// Springs and damping as those of the door: a step may not turn a joint round.
void BoltBody::ApplySpring(double time_step_s) {
  const double damping = std::min(bolt_.damping_n_s_m, 0.5 * bolt_.mass_kg / time_step_s);
  const double force = bolt_.preload_n - bolt_.stiffness_n_per_m * position_m();
  door_.multibody().addJointTorque(links_.bolt, force - damping * velocity_m_s());
}

}  // namespace doorforge::internal

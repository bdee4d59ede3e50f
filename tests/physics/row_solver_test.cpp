// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/row_solver.h"

#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <gtest/gtest.h>

namespace doorforge::internal {
namespace {

constexpr double kStepS = 1.0 / 240;

// A jaw that a motor pushes along x against a plate that hangs on a hinge, both leaning on a fixed
// block, in gravity: motors, limits, contacts that stick and slip, of two bodies and of one.
class Jaw {
 public:
  explicit Jaw(std::unique_ptr<btMultiBodyConstraintSolver> solver, bool free_base)
      : solver_(std::move(solver)),
        world_(&dispatcher_, &broadphase_, solver_.get(), &configuration_) {
    world_.setGravity(btVector3(0, 0.7, -9.81));
    btContactSolverInfo& info = world_.getSolverInfo();
    info.m_numIterations = 30;
    info.m_leastSquaresResidualThreshold = 0;
    info.m_splitImpulse = 0;
    info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
    AddJaw(free_base);
    AddPlate();
    AddBlock();
  }
  ~Jaw() {
    for (const auto& constraint : constraints_) world_.removeMultiBodyConstraint(constraint.get());
    for (const auto& body : bodies_) world_.removeMultiBody(body.get());
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }
  Jaw(const Jaw&) = delete;
  Jaw& operator=(const Jaw&) = delete;

  void Step() { world_.stepSimulation(kStepS, 0); }
  int contacts() {
    int count = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
      count += dispatcher_.getManifoldByIndexInternal(i)->getNumContacts();
    return count;
  }
  std::vector<double> State() const {
    std::vector<double> state;
    for (const auto& body : bodies_)
      for (int i = 0; i < body->getNumDofs(); ++i)
        state.insert(state.end(), {body->getJointPos(i), body->getJointVel(i)});
    for (int i = 0; i < 3; ++i) state.push_back(bodies_[0]->getBasePos()[i]);
    return state;
  }

 private:
  void AddJaw(bool free_base) {
    bodies_.push_back(
        std::make_unique<btMultiBody>(2, 3.0, btVector3(0.1, 0.1, 0.1), !free_base, false));
    btMultiBody& jaw = *bodies_.back();
    jaw.setupPrismatic(0, 1.0, btVector3(0.01, 0.01, 0.01), -1, btQuaternion::getIdentity(),
                       btVector3(1, 0, 0), btVector3(0, 0, 0), btVector3(0, 0, 0), true);
    jaw.setupRevolute(1, 0.5, btVector3(0.01, 0.01, 0.01), 0, btQuaternion::getIdentity(),
                      btVector3(0, 0, 1), btVector3(0.1, 0, 0), btVector3(0.1, 0, 0), true);
    Finish(jaw, 1, btVector3(0.1, 0.05, 0.05));
    AddMotor(jaw, 0, 0.3);
    AddMotor(jaw, 1, 0.0);
  }
  void AddPlate() {
    bodies_.push_back(std::make_unique<btMultiBody>(1, 0.0, btVector3(0, 0, 0), true, false));
    btMultiBody& plate = *bodies_.back();
    plate.setBasePos(btVector3(0.36, 0.3, 0.0));
    plate.setupRevolute(0, 2.0, btVector3(0.02, 0.02, 0.02), -1, btQuaternion::getIdentity(),
                        btVector3(0, 0, 1), btVector3(0, 0, 0), btVector3(0, -0.3, 0), true);
    Finish(plate, 0, btVector3(0.02, 0.3, 0.2));
    constraints_.push_back(
        std::make_unique<btMultiBodyJointLimitConstraint>(&plate, 0, -0.3, 0.15));
    world_.addMultiBodyConstraint(constraints_.back().get());
  }
  void AddBlock() {
    shapes_.push_back(std::make_unique<btBoxShape>(btVector3(0.5, 0.5, 0.1)));
    objects_.push_back(std::make_unique<btCollisionObject>());
    objects_.back()->setCollisionShape(shapes_.back().get());
    objects_.back()->setFriction(0.4);
    objects_.back()->setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -0.149)));
    world_.addCollisionObject(objects_.back().get(), btBroadphaseProxy::StaticFilter,
                              btBroadphaseProxy::AllFilter);
  }
  void AddMotor(btMultiBody& body, int joint, double speed) {
    auto motor = std::make_unique<btMultiBodyJointMotor>(&body, joint, speed, 60 * kStepS);
    world_.addMultiBodyConstraint(motor.get());
    constraints_.push_back(std::move(motor));
  }
  void Finish(btMultiBody& body, int link, const btVector3& half) {
    body.finalizeMultiDof();
    shapes_.push_back(std::make_unique<btBoxShape>(half));
    auto collider = std::make_unique<btMultiBodyLinkCollider>(&body, link);
    collider->setCollisionShape(shapes_.back().get());
    collider->setFriction(0.9);
    body.getLink(link).m_collider = collider.get();
    world_.addMultiBody(&body);
    world_.addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                              btBroadphaseProxy::AllFilter);
    objects_.push_back(std::move(collider));
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btMultiBodyConstraintSolver> solver_;
  btMultiBodyDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btMultiBody>> bodies_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
};

void ExpectTheStateOfBulletsOwnSolver(bool free_base) {
  Jaw own(std::make_unique<RowSolver>(DeepFriction::kFull), free_base);
  Jaw bullets(std::make_unique<btMultiBodyConstraintSolver>(), free_base);
  int most_contacts = 0;
  for (int step = 0; step < 240; ++step) {
    own.Step();
    bullets.Step();
    most_contacts = std::max(most_contacts, bullets.contacts());
    const std::vector<double> a = own.State();
    const std::vector<double> b = bullets.State();
    for (std::size_t i = 0; i < a.size(); ++i)
      ASSERT_NEAR(a[i], b[i], 1e-9) << "number " << i << " after step " << step;
  }
  EXPECT_GE(most_contacts, 6);
  EXPECT_GT(std::abs(bullets.State()[0]), 0.02) << "nothing moved";
}

TEST(RowSolver, GivesTheStatesOfBulletsOwnSolverForBodiesThatStandFast) {
  ExpectTheStateOfBulletsOwnSolver(false);
}

TEST(RowSolver, GivesTheStatesOfBulletsOwnSolverForABodyThatIsFree) {
  ExpectTheStateOfBulletsOwnSolver(true);
}

// A block that lies `depth` deep in another and slides on it: speed that friction took from it in
// one step, by the speed with which it was pushed out.
double FrictionPerPush(double depth) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  RowSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, 0));
  world.getSolverInfo().m_splitImpulse = 0;
  world.getSolverInfo().m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS;

  btBoxShape shape(btVector3(0.1, 0.1, 0.1));
  btCollisionObject ground;
  ground.setCollisionShape(&shape);
  ground.setFriction(0.4);
  world.addCollisionObject(&ground, btBroadphaseProxy::StaticFilter, btBroadphaseProxy::AllFilter);
  // does not tilt
  btMultiBody block(0, 1.0, btVector3(1e6, 1e6, 1e6), false, false);
  block.setLinearDamping(0);
  block.finalizeMultiDof();
  block.setBasePos(btVector3(0, 0, 0.2 - depth));
  block.setBaseVel(btVector3(1, 0, 0));
  btMultiBodyLinkCollider collider(&block, -1);
  collider.setCollisionShape(&shape);
  collider.setFriction(1);
  collider.setWorldTransform(block.getBaseWorldTransform());
  block.setBaseCollider(&collider);
  world.addMultiBody(&block);
  world.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter,
                           btBroadphaseProxy::AllFilter);
  world.stepSimulation(kStepS, 0);
  const btVector3 velocity = block.getBaseVel();
  world.removeCollisionObject(&collider);
  world.removeCollisionObject(&ground);
  world.removeMultiBody(&block);
  EXPECT_GT(velocity.z(), 0) << "nothing pushed it out";
  return (1 - velocity.x()) / velocity.z();
}

TEST(RowSolver, FrictionIsCoulombsAndFadesInBodiesThatAreInsideEachOther) {
  EXPECT_NEAR(FrictionPerPush(0.001), 0.4, 1e-6);
  EXPECT_NEAR(FrictionPerPush(0.0029), 0.4, 1e-6);
  EXPECT_NEAR(FrictionPerPush(0.0045), 0.2, 1e-6);
  EXPECT_NEAR(FrictionPerPush(0.0061), 0, 1e-6);
  EXPECT_NEAR(FrictionPerPush(0.02), 0, 1e-6);
}

}  // namespace
}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/Featherstone/btMultiBodyInplaceSolverIslandCallback.h>

#include "collision/bullet_memory.h"
#include "collision/row_solver.h"
#include "robot/robot_body.h"
#include "robot/self_collision.h"
#include "world/contact_report.h"
#include "world/door_body.h"
#include "world/step_energy_audit.h"
#include "world/world_engine.h"

namespace doorforge::internal {
namespace {

// More pairs than robot and door have near each other; with more, Bullet allocates one by one.
// Its own default of 4096 would make every world and every image of one 8 MB larger.
btDefaultCollisionConstructionInfo SmallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 256;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  return info;
}

/// Bullet's world, which keeps a part of itself where no BulletMemory is asked.
class IslandWorld : public btMultiBodyDynamicsWorld {
 public:
  using btMultiBodyDynamicsWorld::btMultiBodyDynamicsWorld;
  void AddTo(BulletMemory& memory) {
    memory.AddRegion(static_cast<btMultiBodyDynamicsWorld*>(this),
                     sizeof(btMultiBodyDynamicsWorld));
    memory.AddRegion(m_solverMultiBodyIslandCallback, sizeof(*m_solverMultiBodyIslandCallback));
  }
};

/// All that Bullet knows of a scene. To be made, used and destroyed within a scope of its memory.
struct BulletScene {
  BulletScene(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
              const JointVector& start, SelfCollisionFilter& self_collisions) {
    ConfigureSolver(scene.physics);
    world.getPairCache()->setOverlapFilterCallback(&self_collisions);
    robot_body = std::make_unique<RobotBody>(world, scene, robot, start);
    door_body = std::make_unique<DoorBody>(world, scene.world_from_door, door, scene.latch,
                                           scene.physics.handle_friction);
  }

  void ConfigureSolver(const PhysicsConfig& physics);
  void AddTo(BulletMemory& memory);

  btDefaultCollisionConfiguration collision_configuration{SmallPools()};
  btCollisionDispatcher dispatcher{&collision_configuration};
  btDbvtBroadphase broadphase;
  RowSolver solver;
  IslandWorld world{&dispatcher, &broadphase, &solver, &collision_configuration};
  std::unique_ptr<RobotBody> robot_body;
  std::unique_ptr<DoorBody> door_body;
};

void BulletScene::ConfigureSolver(const PhysicsConfig& physics) {
  world.setGravity(btVector3(0, 0, 0));
  btContactSolverInfo& info = world.getSolverInfo();
  info.m_numIterations = physics.solver_iterations;
  info.m_erp = 0.2;
  info.m_erp2 = 0.2;
  info.m_frictionERP = 0.2;
  info.m_globalCfm = 0;
  info.m_splitImpulse = 0;
  info.m_linearSlop = 0;
  info.m_leastSquaresResidualThreshold = 0;
  // with one friction direction a knob slips through the pads
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
}

// What Bullet itself allocates is in the memory anyway.
void BulletScene::AddTo(BulletMemory& memory) {
  memory.AddRegion(&dispatcher, sizeof dispatcher);
  memory.AddRegion(&broadphase, sizeof broadphase);
  // the row solver's own members live for one step
  memory.AddRegion(static_cast<btMultiBodyConstraintSolver*>(&solver),
                   sizeof(btMultiBodyConstraintSolver));
  world.AddTo(memory);
}

struct SavedBullet : SavedWorld {
  SavedBullet(BulletMemory::Image memory, LatchState latch_state, StepEnergyAudit::Memory audit)
      : bullet(std::move(memory)), latch(latch_state), monitor(std::move(audit)) {}

  std::size_t size_bytes() const override {
    std::size_t size = 0;
    for (const auto* parts : {&bullet.blocks, &bullet.regions})
      for (const auto& bytes : *parts) size += bytes.size();
    return size;
  }

  BulletMemory::Image bullet;
  LatchState latch;
  StepEnergyAudit::Memory monitor;
};

class BulletEngine final : public WorldEngine {
 public:
  BulletEngine(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
               const JointVector& start);
  ~BulletEngine() override;

  void Step(const RobotCommand& command) override;
  void Place(const WorldState& at) override;
  DoorContacts Contacts() const override;

 protected:
  std::shared_ptr<SavedWorld> SaveOwn() const override;
  void RestoreOwn(const SavedWorld& image) override;

 private:
  void ReadState();
  void RememberRotations();
  void TurnCachedNormals();

  BulletMemory memory_;
  std::unique_ptr<SelfCollisionFilter> self_collisions_;
  std::unique_ptr<BulletScene> bullet_;
  std::unique_ptr<StepEnergyAudit> monitor_;
  std::vector<btMatrix3x3> rotation_before_;  // of every collision object, before the step
};

BulletEngine::BulletEngine(const Scene& the_scene, const DoorAsset& the_door,
                           const RobotModel& the_robot, const JointVector& start)
    : WorldEngine(the_scene, the_door, the_robot) {
  SwitchProfilingOff();
  self_collisions_ = std::make_unique<SelfCollisionFilter>(robot);
  const BulletMemory::Scope scope(memory_);
  bullet_ = std::make_unique<BulletScene>(scene, door, robot, start, *self_collisions_);
  bullet_->AddTo(memory_);
  monitor_ = std::make_unique<StepEnergyAudit>(bullet_->robot_body->body(),
                                               bullet_->door_body->body(), robot, door);
  ReadState();
}

BulletEngine::~BulletEngine() {
  const BulletMemory::Scope scope(memory_);
  bullet_.reset();
}

void BulletEngine::ReadState() {
  state.robot_position = bullet_->robot_body->Positions();
  state.robot_velocity = bullet_->robot_body->Velocities();
  state.hinge_rad = bullet_->door_body->hinge_rad();
  state.hinge_rad_s = bullet_->door_body->hinge_rad_s();
  state.handle_rad = bullet_->door_body->handle_rad();
  state.handle_rad_s = bullet_->door_body->handle_rad_s();
  state.locked = bullet_->door_body->latch().locked;
  state.handle_done = bullet_->door_body->latch().handle_done;
  state.bolt_m = bullet_->door_body->bolt_m();
  state.bolt_m_s = bullet_->door_body->bolt_m_s();
}

void BulletEngine::RememberRotations() {
  const btCollisionObjectArray& objects = bullet_->world.getCollisionObjectArray();
  rotation_before_.clear();
  for (int i = 0; i < objects.size(); ++i) {
    objects[i]->setUserIndex(i);
    rotation_before_.push_back(objects[i]->getWorldTransform().getBasis());
  }
}

// Bullet keeps a contact point for many steps and moves it with its bodies, but not its normal. On
// a hand that turns a knob the old normals lean over, and squeeze alone would turn the knob: 2 N m
// at a friction of 0.02. So the normals are turned along with the body that they are on.
void BulletEngine::TurnCachedNormals() {
  for (int i = 0; i < bullet_->dispatcher.getNumManifolds(); ++i) {
    btPersistentManifold& manifold = *bullet_->dispatcher.getManifoldByIndexInternal(i);
    const btCollisionObject* body = manifold.getBody1();
    const btMatrix3x3 turn =
        body->getWorldTransform().getBasis() *
        rotation_before_[static_cast<std::size_t>(body->getUserIndex())].transpose();
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      btVector3& normal = manifold.getContactPoint(j).m_normalWorldOnB;
      normal = turn * normal;
    }
  }
}

void BulletEngine::Step(const RobotCommand& command) {
  const BulletMemory::Scope scope(memory_);
  bullet_->robot_body->Command(command);
  bullet_->door_body->ApplyTorques(extra_hinge_torque, extra_handle_torque,
                                   scene.physics.time_step_s);
  extra_hinge_torque = 0;
  extra_handle_torque = 0;
  fault = monitor_->BeforeStep(state.time_s);
  if (fault) return;
  RememberRotations();
  bullet_->world.stepSimulation(scene.physics.time_step_s, 0);
  TurnCachedNormals();
  bullet_->door_body->UpdateLatch();
  state.time_s += scene.physics.time_step_s;
  ReadState();
  fault = monitor_->AfterStep(bullet_->dispatcher, scene.physics.time_step_s);
}

void BulletEngine::Place(const WorldState& at) {
  const BulletMemory::Scope scope(memory_);
  for (int i = 0; i < static_cast<int>(at.robot_position.size()); ++i)
    bullet_->robot_body->body().PlaceJoint(i, at.robot_position[i], at.robot_velocity[i]);
  bullet_->door_body->body().PlaceJoint(0, at.hinge_rad, at.hinge_rad_s);
  bullet_->door_body->body().PlaceJoint(1, at.handle_rad, at.handle_rad_s);
  bullet_->robot_body->body().SyncColliders();
  bullet_->door_body->body().SyncColliders();
  ReadState();
}

DoorContacts BulletEngine::Contacts() const {
  return ReportContacts(bullet_->dispatcher, *bullet_->robot_body, *bullet_->door_body,
                        scene.physics.time_step_s);
}

std::shared_ptr<SavedWorld> BulletEngine::SaveOwn() const {
  return std::make_shared<SavedBullet>(memory_.Copy(), bullet_->door_body->latch(),
                                       monitor_->memory());
}

void BulletEngine::RestoreOwn(const SavedWorld& image) {
  const auto& own = dynamic_cast<const SavedBullet&>(image);
  memory_.Restore(own.bullet);
  bullet_->door_body->RestoreLatch(own.latch);
  monitor_->Restore(own.monitor);
}

}  // namespace

std::unique_ptr<WorldEngine> MakeBulletEngine(const Scene& scene, const DoorAsset& door,
                                              const RobotModel& robot, const JointVector& start) {
  return std::make_unique<BulletEngine>(scene, door, robot, start);
}

}  // namespace doorforge::internal

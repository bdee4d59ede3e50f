// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/door_world.h"

#include <span>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/Featherstone/btMultiBodyInplaceSolverIslandCallback.h>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

#include "collision/bullet_memory.h"
#include "collision/row_solver.h"
#include "robot/robot_body.h"
#include "robot/self_collision.h"
#include "world/contact_report.h"
#include "world/door_body.h"
#include "world/step_energy_audit.h"

namespace doorforge {
namespace {

void Check(const PhysicsConfig& config) {
  constexpr int kMost = 10'000;  // what takes longer is a mistake
  const bool good =
      config.time_step_s >= 1e-5 && config.time_step_s <= 0.02 && config.solver_iterations > 0 &&
      config.solver_iterations <= kMost && config.steps_per_action > 0 &&
      config.steps_per_action <= kMost && config.finger_friction >= 0 &&
      config.handle_friction >= 0 && config.finger_force_n > 0 && config.operational_space.kp > 0 &&
      config.operational_space.posture_kp > 0 && config.operational_space.armature >= 0 &&
      config.operational_space.lead_m > 0 && config.operational_space.lead_rad > 0;
  Require(good, ErrorCode::kInvalidConfig,
          "physics: time_step_s must lie in [0.00001, 0.02], frictions be >= 0, all other numbers "
          "be positive, and solver_iterations and steps_per_action at most 10000");
}

// The scene's robot stands as the robot is made, and is this one.
void Check(const Scene& scene, const RobotModel& robot) {
  Require(scene.physics.base == robot.base(), ErrorCode::kInvalidArgument,
          "the scene has physics.base: " + std::string(NameOf(scene.physics.base)) +
              ", but the robot was loaded with " + std::string(NameOf(robot.base())));
  Require(scene.robot.sha256.empty() || scene.robot.sha256 == robot.sha256(),
          ErrorCode::kInvalidArgument,
          "the scene is of robot \"" + scene.robot.name + "\" with another hash than this \"" +
              robot.name() + '"');
}

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
  void AddTo(internal::BulletMemory& memory) {
    memory.AddRegion(static_cast<btMultiBodyDynamicsWorld*>(this),
                     sizeof(btMultiBodyDynamicsWorld));
    memory.AddRegion(m_solverMultiBodyIslandCallback, sizeof(*m_solverMultiBodyIslandCallback));
  }
};

/// All that Bullet knows of a scene. To be made, used and destroyed within a scope of its memory.
struct BulletScene {
  BulletScene(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
              const JointVector& start, internal::SelfCollisionFilter& self_collisions) {
    ConfigureSolver(scene.physics);
    world.getPairCache()->setOverlapFilterCallback(&self_collisions);
    robot_body = std::make_unique<internal::RobotBody>(world, scene, robot, start);
    door_body = std::make_unique<internal::DoorBody>(world, scene.world_from_door, door,
                                                     scene.latch, scene.physics.handle_friction);
  }

  void ConfigureSolver(const PhysicsConfig& physics);
  void AddTo(internal::BulletMemory& memory);

  btDefaultCollisionConfiguration collision_configuration{SmallPools()};
  btCollisionDispatcher dispatcher{&collision_configuration};
  btDbvtBroadphase broadphase;
  internal::RowSolver solver;
  IslandWorld world{&dispatcher, &broadphase, &solver, &collision_configuration};
  std::unique_ptr<internal::RobotBody> robot_body;
  std::unique_ptr<internal::DoorBody> door_body;
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
void BulletScene::AddTo(internal::BulletMemory& memory) {
  memory.AddRegion(&dispatcher, sizeof dispatcher);
  memory.AddRegion(&broadphase, sizeof broadphase);
  // the row solver's own members live for one step
  memory.AddRegion(static_cast<btMultiBodyConstraintSolver*>(&solver),
                   sizeof(btMultiBodyConstraintSolver));
  world.AddTo(memory);
}

}  // namespace

/// A state with all that the next steps depend on.
struct WorldImage::Content {
  std::weak_ptr<const void> world;  // the one that it is of
  internal::BulletMemory::Image bullet;
  WorldState state;
  std::optional<StateFault> fault;
  LatchState latch;
  internal::StepEnergyAudit::Memory monitor;
  double extra_hinge_torque = 0;
  double extra_handle_torque = 0;
};

class DoorWorld::Runtime {
 public:
  Runtime(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
          const JointVector& start);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  void Step(const RobotCommand& command);
  void Place(const WorldState& at);
  DoorContacts Contacts() const;
  WorldImage::Content Save() const;
  void Restore(const WorldImage::Content& image);

  Scene scene;
  DoorAsset door;
  RobotModel robot;
  WorldState state;
  std::optional<StateFault> fault;
  double extra_hinge_torque = 0;
  double extra_handle_torque = 0;

 private:
  void ReadState();
  void RememberRotations();
  void TurnCachedNormals();

  std::shared_ptr<const void> identity_ = std::make_shared<int>();
  internal::BulletMemory memory_;
  std::unique_ptr<internal::SelfCollisionFilter> self_collisions_;
  std::unique_ptr<BulletScene> bullet_;
  std::unique_ptr<internal::StepEnergyAudit> monitor_;
  std::vector<btMatrix3x3> rotation_before_;  // of every collision object, before the step
};

DoorWorld::Runtime::Runtime(const Scene& the_scene, const DoorAsset& the_door,
                            const RobotModel& the_robot, const JointVector& start)
    : scene(the_scene), door(the_door), robot(the_robot) {
  Check(scene.physics);
  Check(scene, robot);
  RequireSimulatable(door, "simulated world");
  internal::SwitchProfilingOff();
  self_collisions_ = std::make_unique<internal::SelfCollisionFilter>(robot);
  const internal::BulletMemory::Scope scope(memory_);
  bullet_ = std::make_unique<BulletScene>(scene, door, robot, start, *self_collisions_);
  bullet_->AddTo(memory_);
  monitor_ = std::make_unique<internal::StepEnergyAudit>(bullet_->robot_body->body(),
                                                         bullet_->door_body->body(), robot, door);
  ReadState();
}

DoorWorld::Runtime::~Runtime() {
  const internal::BulletMemory::Scope scope(memory_);
  bullet_.reset();
}

void DoorWorld::Runtime::ReadState() {
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

void DoorWorld::Runtime::RememberRotations() {
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
void DoorWorld::Runtime::TurnCachedNormals() {
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

void DoorWorld::Runtime::Step(const RobotCommand& command) {
  if (fault) return;
  if (!command.arm_position.allFinite()) {
    fault = StateFault{DivergenceKind::kNotFinite, "command", 0, 0, state.time_s};
    return;
  }
  const internal::BulletMemory::Scope scope(memory_);
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

void DoorWorld::Runtime::Place(const WorldState& at) {
  Require(at.robot_position.size() == state.robot_position.size() &&
              at.robot_velocity.size() == state.robot_velocity.size(),
          ErrorCode::kInvalidArgument, "the state is one of a robot with other joints");
  const internal::BulletMemory::Scope scope(memory_);
  for (int i = 0; i < static_cast<int>(at.robot_position.size()); ++i)
    bullet_->robot_body->body().PlaceJoint(i, at.robot_position[i], at.robot_velocity[i]);
  bullet_->door_body->body().PlaceJoint(0, at.hinge_rad, at.hinge_rad_s);
  bullet_->door_body->body().PlaceJoint(1, at.handle_rad, at.handle_rad_s);
  bullet_->robot_body->body().SyncColliders();
  bullet_->door_body->body().SyncColliders();
  ReadState();
}

DoorContacts DoorWorld::Runtime::Contacts() const {
  return internal::ReportContacts(bullet_->dispatcher, *bullet_->robot_body, *bullet_->door_body,
                                  scene.physics.time_step_s);
}

WorldImage::Content DoorWorld::Runtime::Save() const {
  return {identity_,
          memory_.Copy(),
          state,
          fault,
          bullet_->door_body->latch(),
          monitor_->memory(),
          extra_hinge_torque,
          extra_handle_torque};
}

void DoorWorld::Runtime::Restore(const WorldImage::Content& image) {
  Require(image.world.lock() == identity_, ErrorCode::kInvalidArgument,
          "the image is of another world; a world can be put back into its own states alone");
  memory_.Restore(image.bullet);
  state = image.state;
  fault = image.fault;
  bullet_->door_body->RestoreLatch(image.latch);
  monitor_->Restore(image.monitor);
  extra_hinge_torque = image.extra_hinge_torque;
  extra_handle_torque = image.extra_handle_torque;
}

DoorWorld::DoorWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                     const JointVector& start)
    : runtime_(std::make_unique<Runtime>(scene, door, robot, start)) {}
DoorWorld::~DoorWorld() = default;
DoorWorld::DoorWorld(DoorWorld&&) noexcept = default;
DoorWorld& DoorWorld::operator=(DoorWorld&&) noexcept = default;

void DoorWorld::Step(const RobotCommand& command) { runtime_->Step(command); }

const WorldState& DoorWorld::state() const { return runtime_->state; }

DoorContacts DoorWorld::Contacts() const { return runtime_->Contacts(); }

void DoorWorld::PushLeaf(const Eigen::Vector3d& point_m, const Eigen::Vector3d& force_n) {
  runtime_->extra_hinge_torque += runtime_->door.hinge.axis.dot(point_m.cross(force_n));
}

void DoorWorld::TurnHandle(double torque_nm) { runtime_->extra_handle_torque += torque_nm; }

std::array<RigidTransform, 3> DoorWorld::WorldFromDoorLinks() const {
  const WorldState& now = runtime_->state;
  auto poses = DoorFromLinks(runtime_->door, now.hinge_rad, now.handle_rad);
  for (RigidTransform& pose : poses) pose = runtime_->scene.world_from_door * pose;
  return poses;
}

RobotPose DoorWorld::PoseOfRobot() const {
  return runtime_->robot.PoseAt(runtime_->state.robot_position,
                                runtime_->scene.world_from_robot_base);
}

void DoorWorld::Place(const WorldState& state) { runtime_->Place(state); }

WorldImage DoorWorld::Save() const {
  WorldImage image;
  image.content_ = std::make_shared<const WorldImage::Content>(runtime_->Save());
  return image;
}

void DoorWorld::Restore(const WorldImage& image) {
  Require(image.content_ != nullptr, ErrorCode::kInvalidArgument,
          "the image is empty; take one with Save() first");
  runtime_->Restore(*image.content_);
}

std::size_t WorldImage::size_bytes() const {
  if (content_ == nullptr) return 0;
  std::size_t size = 0;
  for (const auto* parts : {&content_->bullet.blocks, &content_->bullet.regions})
    for (const auto& bytes : *parts) size += bytes.size();
  return size;
}

const std::optional<StateFault>& DoorWorld::fault() const { return runtime_->fault; }

std::string DoorWorld::StateHash() const {
  const WorldState& now = runtime_->state;
  std::vector<double> numbers(now.robot_position.begin(), now.robot_position.end());
  numbers.insert(numbers.end(), now.robot_velocity.begin(), now.robot_velocity.end());
  numbers.insert(numbers.end(), {now.hinge_rad, now.hinge_rad_s, now.handle_rad, now.handle_rad_s});
  if (runtime_->scene.latch.type == LatchType::kBolt)
    numbers.insert(numbers.end(), {now.bolt_m, now.bolt_m_s});
  Sha256 hash;
  hash.Update(std::as_bytes(std::span(numbers)));
  return hash.HexDigest();
}

}  // namespace doorforge

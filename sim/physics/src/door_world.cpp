// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/door_world.h"

#include <span>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

#include "contact_report.h"
#include "door_body.h"
#include "robot_body.h"
#include "row_solver.h"
#include "self_collision.h"
#include "world_monitor.h"

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
  Require(config.controller == "joint_motors" || config.controller == "operational_space",
          ErrorCode::kInvalidConfig,
          "physics.controller: found \"" + config.controller +
              "\", allowed joint_motors, operational_space");
}

// The scene's robot stands as the robot is made, and is this one.
void Check(const Scene& scene, const RobotModel& robot) {
  Require(RobotBaseNamed(scene.physics.base) == robot.base(), ErrorCode::kInvalidArgument,
          "the scene has physics.base: " + scene.physics.base + ", but the robot was loaded with " +
              NameOf(robot.base()));
  Require(scene.robot.sha256.empty() || scene.robot.sha256 == robot.sha256(),
          ErrorCode::kInvalidArgument,
          "the scene is of robot \"" + scene.robot.name + "\" with another hash than this \"" +
              robot.name() + '"');
}

}  // namespace

class DoorWorld::Runtime {
 public:
  Runtime(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
          const JointVector& start);
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  void Step(const RobotCommand& command);
  void Place(const WorldState& at);
  DoorContacts Contacts() const;

  Scene scene;
  DoorAsset door;
  RobotModel robot;
  WorldState state;
  std::optional<StateFault> fault;
  double extra_hinge_torque = 0;
  double extra_handle_torque = 0;

 private:
  void ConfigureSolver();
  void ReadState();
  void RememberRotations();
  void TurnCachedNormals();

  btDefaultCollisionConfiguration collision_configuration_;
  mutable btCollisionDispatcher dispatcher_{&collision_configuration_};
  std::unique_ptr<internal::SelfCollisionFilter> self_collisions_;
  btDbvtBroadphase broadphase_;
  internal::RowSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &collision_configuration_};
  std::unique_ptr<internal::RobotBody> robot_body_;
  std::unique_ptr<internal::DoorBody> door_body_;
  std::unique_ptr<internal::WorldMonitor> monitor_;
  std::vector<btMatrix3x3> rotation_before_;  // of every collision object, before the step
};

DoorWorld::Runtime::Runtime(const Scene& the_scene, const DoorAsset& the_door,
                            const RobotModel& the_robot, const JointVector& start)
    : scene(the_scene), door(the_door), robot(the_robot) {
  Check(scene.physics);
  Check(scene, robot);
  RequireSimulatable(door, "simulated world");
  internal::SwitchProfilingOff();
  ConfigureSolver();
  self_collisions_ = std::make_unique<internal::SelfCollisionFilter>(robot);
  world_.getPairCache()->setOverlapFilterCallback(self_collisions_.get());
  robot_body_ = std::make_unique<internal::RobotBody>(world_, scene, robot, start);
  door_body_ = std::make_unique<internal::DoorBody>(world_, scene.world_from_door, door,
                                                    scene.latch, scene.physics.handle_friction);
  monitor_ = std::make_unique<internal::WorldMonitor>(robot_body_->body(), door_body_->body(),
                                                      robot, door);
  ReadState();
}

void DoorWorld::Runtime::ConfigureSolver() {
  world_.setGravity(btVector3(0, 0, 0));
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = scene.physics.solver_iterations;
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

void DoorWorld::Runtime::ReadState() {
  state.robot_position = robot_body_->Positions();
  state.robot_velocity = robot_body_->Velocities();
  state.hinge_rad = door_body_->hinge_rad();
  state.hinge_rad_s = door_body_->hinge_rad_s();
  state.handle_rad = door_body_->handle_rad();
  state.handle_rad_s = door_body_->handle_rad_s();
  state.locked = door_body_->latch().locked;
  state.handle_done = door_body_->latch().handle_done;
  state.bolt_m = door_body_->bolt_m();
  state.bolt_m_s = door_body_->bolt_m_s();
}

void DoorWorld::Runtime::RememberRotations() {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
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
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
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
    fault = StateFault{Implausibility::kNotFinite, "command", 0, 0, state.time_s};
    return;
  }
  robot_body_->Command(command);
  door_body_->ApplyTorques(extra_hinge_torque, extra_handle_torque, scene.physics.time_step_s);
  extra_hinge_torque = 0;
  extra_handle_torque = 0;
  fault = monitor_->BeforeStep(state.time_s);
  if (fault) return;
  RememberRotations();
  world_.stepSimulation(scene.physics.time_step_s, 0);
  TurnCachedNormals();
  door_body_->UpdateLatch();
  state.time_s += scene.physics.time_step_s;
  ReadState();
  fault = monitor_->AfterStep(dispatcher_, scene.physics.time_step_s);
}

void DoorWorld::Runtime::Place(const WorldState& at) {
  Require(at.robot_position.size() == state.robot_position.size() &&
              at.robot_velocity.size() == state.robot_velocity.size(),
          ErrorCode::kInvalidArgument, "the state is one of a robot with other joints");
  for (int i = 0; i < static_cast<int>(at.robot_position.size()); ++i)
    robot_body_->body().PlaceJoint(i, at.robot_position[i], at.robot_velocity[i]);
  door_body_->body().PlaceJoint(0, at.hinge_rad, at.hinge_rad_s);
  door_body_->body().PlaceJoint(1, at.handle_rad, at.handle_rad_s);
  robot_body_->body().SyncColliders();
  door_body_->body().SyncColliders();
  ReadState();
}

DoorContacts DoorWorld::Runtime::Contacts() const {
  return internal::ReportContacts(dispatcher_, *robot_body_, *door_body_,
                                  scene.physics.time_step_s);
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

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/door_world.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/physics/latch_law.h"

#include "bullet_body.h"
#include "door_body.h"

namespace doorforge {
namespace {

using internal::BulletBody;
using internal::BulletJoint;
using internal::BulletLink;
using internal::ContactSide;
using internal::DampingTorque;
using internal::DoorLinks;
using internal::kHandle;
using internal::kHinge;

constexpr double kTouchDistance = 0.001;
// Drives as measured to work in docs/design/simulation.md.
constexpr double kArmPositionGain = 0.2;
constexpr double kFingerSpeed = 0.1;
constexpr double kFingerOpenForce = 100;
constexpr double kGearForce = 200;

void Check(const PhysicsConfig& config) {
  const bool good = config.time_step_s > 0 && config.time_step_s <= 0.02 &&
                    config.solver_iterations > 0 && config.steps_per_action > 0 &&
                    config.finger_friction >= 0 && config.handle_friction >= 0 &&
                    config.finger_force_n > 0;
  Require(good, ErrorCode::kInvalidArgument,
          "physics: time_step_s must lie in (0, 0.02], frictions be >= 0, and all other numbers "
          "be positive");
}

std::vector<BulletLink> RobotLinks(const RobotModel& robot, double finger_friction) {
  std::vector<BulletLink> links;
  for (const RobotJoint& joint : robot.joints()) {
    BulletLink link;
    link.joint = joint.prismatic ? BulletJoint::kPrismatic : BulletJoint::kRevolute;
    link.parent = joint.parent;
    link.parent_from_joint = joint.parent_from_joint;
    link.axis = joint.axis;
    link.lower = joint.lower;
    link.upper = joint.upper;
    link.mass = joint.mass;
    link.least_inertia_kg_m2 = joint.prismatic ? 1e-3 : 1e-2;
    links.push_back(link);
  }
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint >= 0) links[static_cast<std::size_t>(piece.joint)].hulls.push_back(piece.mesh);
  }
  for (const int finger : {kLeftFinger, kRightFinger})
    links[static_cast<std::size_t>(finger)].friction = finger_friction;
  links[kArmJointCount - 1].friction = 0.3;
  return links;
}

}  // namespace

class DoorWorld::Runtime {
 public:
  Runtime(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
          const JointVector& start);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  void Step(const RobotCommand& command);
  DoorContacts Contacts() const;
  bool Healthy() const;

  Scene scene;
  DoorAsset door;
  RobotModel robot;
  WorldState state;
  double extra_hinge_torque = 0;
  double extra_handle_torque = 0;

 private:
  void ConfigureSolver();
  void AddFrame();
  void AddDrives(const JointVector& start);
  void CommandDrives(const RobotCommand& command);
  void ApplyDoorTorques();
  void ReadState();
  void TurnCachedNormals();
  void AddContact(const btPersistentManifold& manifold, DoorContacts& contacts) const;
  std::string NameOfRobotPart(const btCollisionObject* object) const;
  std::string NameOfDoorPart(const btCollisionObject* object) const;

  btDefaultCollisionConfiguration collision_configuration_;
  btCollisionDispatcher dispatcher_{&collision_configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &collision_configuration_};
  btCompoundShape frame_shape_;
  std::vector<std::unique_ptr<btCollisionShape>> frame_hulls_;
  btCollisionObject frame_;
  std::unique_ptr<BulletBody> robot_body_;
  std::unique_ptr<BulletBody> door_body_;
  std::vector<btMultiBodyJointMotor*> arm_motors_;
  std::array<btMultiBodyJointMotor*, 2> finger_motors_{};
  std::vector<btMatrix3x3> rotation_before_;  // of every collision object, before the step
  internal::DoorInertia inertia_;
  LatchState latch_;
};

DoorWorld::Runtime::Runtime(const Scene& the_scene, const DoorAsset& the_door,
                            const RobotModel& the_robot, const JointVector& start)
    : scene(the_scene), door(the_door), robot(the_robot) {
  Check(scene.physics);
  internal::SwitchProfilingOff();
  ConfigureSolver();
  robot_body_ = std::make_unique<BulletBody>(world_, scene.world_from_robot_base,
                                             RobotLinks(robot, scene.physics.finger_friction),
                                             ContactSide::kRobot);
  door_body_ = std::make_unique<BulletBody>(world_, scene.world_from_door,
                                            DoorLinks(door, scene.physics.handle_friction),
                                            ContactSide::kDoor);
  AddFrame();
  AddDrives(start);
  for (int i = 0; i < kRobotJointCount; ++i) {
    const btScalar position = start[i];
    robot_body_->multibody().setJointPosMultiDof(i, &position);
  }
  robot_body_->SyncColliders();
  door_body_->SyncColliders();
  inertia_ = internal::InertiaOf(door);
  latch_ = UpdatedLatch(scene.latch, {}, 0, 0);
  ReadState();
}

DoorWorld::Runtime::~Runtime() {
  if (frame_shape_.getNumChildShapes() > 0) world_.removeCollisionObject(&frame_);
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

void DoorWorld::Runtime::AddFrame() {
  for (const TriangleMesh& mesh : internal::HullsOf(door.links[kBaseLink])) {
    frame_hulls_.push_back(internal::MakeHull(mesh, RigidTransform::Identity()));
    frame_shape_.addChildShape(btTransform::getIdentity(), frame_hulls_.back().get());
  }
  if (frame_hulls_.empty()) return;
  frame_.setCollisionShape(&frame_shape_);
  frame_.setWorldTransform(internal::ToBullet(scene.world_from_door));
  frame_.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  world_.addCollisionObject(&frame_, static_cast<int>(ContactSide::kDoor),
                            static_cast<int>(ContactSide::kRobot));
}

void DoorWorld::Runtime::AddDrives(const JointVector& start) {
  btMultiBody* body = &robot_body_->multibody();
  const double dt = scene.physics.time_step_s;
  for (int i = 0; i < kArmJointCount; ++i) {
    const double effort = robot.joints()[static_cast<std::size_t>(i)].effort;
    auto& motor =
        robot_body_->Add(std::make_unique<btMultiBodyJointMotor>(body, i, 0, effort * dt));
    motor.setErp(1);
    motor.setPositionTarget(start[i], kArmPositionGain);
    motor.setVelocityTarget(0, 1);
    arm_motors_.push_back(&motor);
  }
  for (const int side : {0, 1}) {
    auto& motor = robot_body_->Add(std::make_unique<btMultiBodyJointMotor>(
        body, kLeftFinger + side, 0, kFingerOpenForce * dt));
    motor.setErp(1);
    finger_motors_.at(static_cast<std::size_t>(side)) = &motor;
  }
  // couples the fingers: load on one alone would push the pair sideways
  auto& gear = robot_body_->Add(std::make_unique<btMultiBodyGearConstraint>(
      body, kLeftFinger, body, kRightFinger, btVector3(0, 0, 0), btVector3(0, 0, 0),
      btMatrix3x3::getIdentity(), btMatrix3x3::getIdentity()));
  gear.setGearRatio(-1);
  gear.setErp(0.1);
  gear.setMaxAppliedImpulse(kGearForce * dt);
}

void DoorWorld::Runtime::CommandDrives(const RobotCommand& command) {
  const double dt = scene.physics.time_step_s;
  for (int i = 0; i < kArmJointCount; ++i)
    arm_motors_[static_cast<std::size_t>(i)]->setPositionTarget(command.arm_position[i],
                                                                kArmPositionGain);
  for (btMultiBodyJointMotor* motor : finger_motors_) {
    if (command.close_fingers) {
      // a velocity drive that stalls on the handle presses with just this force
      motor->setPositionTarget(0, 0);
      motor->setVelocityTarget(-kFingerSpeed, 1);
      motor->setMaxAppliedImpulse(scene.physics.finger_force_n * dt);
    } else {
      motor->setPositionTarget(robot.joints()[kLeftFinger].upper, 0.3);
      motor->setVelocityTarget(0, 1);
      motor->setMaxAppliedImpulse(kFingerOpenForce * dt);
    }
  }
}

void DoorWorld::Runtime::ApplyDoorTorques() {
  const double dt = scene.physics.time_step_s;
  const LatchTorques law = TorquesOf(scene.latch, latch_, state.hinge_rad, state.handle_rad);
  const double hinge =
      law.hinge_nm + extra_hinge_torque +
      DampingTorque(door.hinge.damping_nm_s, state.hinge_rad_s, inertia_.hinge, dt);
  const double handle =
      law.handle_nm + extra_handle_torque +
      DampingTorque(door.handle_joint.damping_nm_s, state.handle_rad_s, inertia_.handle, dt);
  // Bullet forgets joint torques after each step
  btMultiBody& body = door_body_->multibody();
  if (body.getLink(kHinge).m_dofCount > 0) body.addJointTorque(kHinge, hinge);
  if (body.getLink(kHandle).m_dofCount > 0) body.addJointTorque(kHandle, handle);
  extra_hinge_torque = 0;
  extra_handle_torque = 0;
}

void DoorWorld::Runtime::ReadState() {
  for (int i = 0; i < kRobotJointCount; ++i) {
    state.robot_position[i] = robot_body_->Position(i);
    state.robot_velocity[i] = robot_body_->Velocity(i);
  }
  state.hinge_rad = door_body_->Position(kHinge);
  state.hinge_rad_s = door_body_->Velocity(kHinge);
  state.handle_rad = door_body_->Position(kHandle);
  state.handle_rad_s = door_body_->Velocity(kHandle);
  latch_ = UpdatedLatch(scene.latch, latch_, state.hinge_rad, state.handle_rad);
  state.locked = latch_.locked;
  state.handle_done = latch_.handle_done;
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
  CommandDrives(command);
  ApplyDoorTorques();
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  rotation_before_.clear();
  for (int i = 0; i < objects.size(); ++i) {
    objects[i]->setUserIndex(i);
    rotation_before_.push_back(objects[i]->getWorldTransform().getBasis());
  }
  world_.stepSimulation(scene.physics.time_step_s, 0);
  TurnCachedNormals();
  state.time_s += scene.physics.time_step_s;
  ReadState();
}

std::string DoorWorld::Runtime::NameOfRobotPart(const btCollisionObject* object) const {
  for (int i = 0; i < kRobotJointCount; ++i) {
    if (object != robot_body_->collider(i)) continue;
    if (i >= kArmJointCount) return "finger";
    if (i == kArmJointCount - 1) return "hand";
    return i < kSliderCount ? "platform" : "link" + std::to_string(i - 1);
  }
  return {};
}

std::string DoorWorld::Runtime::NameOfDoorPart(const btCollisionObject* object) const {
  if (object == door_body_->collider(kHinge)) return "leaf";
  if (object == door_body_->collider(kHandle)) return "handle";
  return "frame";
}

void DoorWorld::Runtime::AddContact(const btPersistentManifold& manifold,
                                    DoorContacts& contacts) const {
  const btCollisionObject* first = manifold.getBody0();
  const btCollisionObject* second = manifold.getBody1();
  if (NameOfRobotPart(first).empty()) std::swap(first, second);
  const bool handle = second == door_body_->collider(kHandle);
  const bool left = first == robot_body_->collider(kLeftFinger);
  const bool right = first == robot_body_->collider(kRightFinger);
  const bool pad = handle && (left || right);
  const auto side = static_cast<std::size_t>(right ? 1 : 0);
  bool touches = false;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    if (pad)
      contacts.pad_distance_m = std::clamp<double>(point.getDistance(), 0, contacts.pad_distance_m);
    if (point.getDistance() >= kTouchDistance) continue;
    touches = true;
    const double force = point.getAppliedImpulse() / scene.physics.time_step_s;
    if (pad) {
      ++contacts.pad_points[side];
      contacts.pad_force_n[side] += force;
      contacts.deepest_m = std::max(contacts.deepest_m, -static_cast<double>(point.getDistance()));
    } else {
      ++contacts.arm_points;
      contacts.arm_force_n += force;
    }
  }
  if (!touches || pad) return;
  if (!contacts.arm_touches.empty()) contacts.arm_touches += ", ";
  contacts.arm_touches += NameOfRobotPart(first) + "-" + NameOfDoorPart(second);
}

DoorContacts DoorWorld::Runtime::Contacts() const {
  DoorContacts contacts;
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold* manifold =
        const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() > 0) AddContact(*manifold, contacts);
  }
  return contacts;
}

bool DoorWorld::Runtime::Healthy() const {
  const bool finite = state.robot_position.allFinite() && state.robot_velocity.allFinite() &&
                      std::isfinite(state.hinge_rad) && std::isfinite(state.hinge_rad_s) &&
                      std::isfinite(state.handle_rad) && std::isfinite(state.handle_rad_s);
  return finite && state.robot_velocity.head<kSliderCount>().cwiseAbs().maxCoeff() < 10 &&
         state.robot_velocity.cwiseAbs().maxCoeff() < 30 && std::abs(state.hinge_rad_s) < 20;
}

DoorWorld::DoorWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                     const JointVector& start)
    : runtime_(std::make_unique<Runtime>(scene, door, robot, start)) {
  RequireSimulatable(door, "simulated world");
}
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

bool DoorWorld::Healthy() const { return runtime_->Healthy(); }

std::string DoorWorld::StateHash() const {
  const WorldState& now = runtime_->state;
  std::vector<double> numbers(now.robot_position.begin(), now.robot_position.end());
  numbers.insert(numbers.end(), now.robot_velocity.begin(), now.robot_velocity.end());
  numbers.insert(numbers.end(), {now.hinge_rad, now.hinge_rad_s, now.handle_rad, now.handle_rad_s});
  Sha256 hash;
  hash.Update(std::as_bytes(std::span(numbers)));
  return hash.HexDigest();
}

}  // namespace doorforge

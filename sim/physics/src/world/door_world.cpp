// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/door_world.h"

#include <span>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

#include "world/world_engine.h"

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

std::unique_ptr<internal::WorldEngine> MakeEngine(const Scene& scene, const DoorAsset& door,
                                                  const RobotModel& robot,
                                                  const JointVector& start) {
  Check(scene.physics);
  Check(scene, robot);
  RequireSimulatable(door, "simulated world");
  return scene.physics.simulator == Simulator::kMujoco
             ? internal::MakeMujocoEngine(scene, door, robot, start)
             : internal::MakeBulletEngine(scene, door, robot, start);
}

}  // namespace

namespace internal {

std::shared_ptr<const SavedWorld> WorldEngine::Save() const {
  std::shared_ptr<SavedWorld> image = SaveOwn();
  image->world = identity_;
  image->state = state;
  image->fault = fault;
  image->extra_hinge_torque = extra_hinge_torque;
  image->extra_handle_torque = extra_handle_torque;
  return image;
}

void WorldEngine::Restore(const SavedWorld& image) {
  Require(image.world.lock() == identity_, ErrorCode::kInvalidArgument,
          "the image is of another world; a world can be put back into its own states alone");
  RestoreOwn(image);
  state = image.state;
  fault = image.fault;
  extra_hinge_torque = image.extra_hinge_torque;
  extra_handle_torque = image.extra_handle_torque;
}

}  // namespace internal

bool HasSimulator(Simulator simulator) {
  return simulator == Simulator::kBullet || internal::BuiltWithMujoco();
}

void RequireSimulator(Simulator simulator) {
  if (simulator == Simulator::kMujoco) internal::RequireMujoco();
}

DoorWorld::DoorWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                     const JointVector& start)
    : engine_(MakeEngine(scene, door, robot, start)) {}
DoorWorld::~DoorWorld() = default;
DoorWorld::DoorWorld(DoorWorld&&) noexcept = default;
DoorWorld& DoorWorld::operator=(DoorWorld&&) noexcept = default;

void DoorWorld::Step(const RobotCommand& command) {
  if (engine_->fault) return;
  if (!command.arm_position.allFinite()) {
    engine_->fault = StateFault{DivergenceKind::kNotFinite, "command", 0, 0, engine_->state.time_s};
    return;
  }
  engine_->Step(command);
}

const WorldState& DoorWorld::state() const { return engine_->state; }

DoorContacts DoorWorld::Contacts() const { return engine_->Contacts(); }

void DoorWorld::PushLeaf(const Eigen::Vector3d& point_m, const Eigen::Vector3d& force_n) {
  engine_->extra_hinge_torque += engine_->door.hinge.axis.dot(point_m.cross(force_n));
}

void DoorWorld::TurnHandle(double torque_nm) { engine_->extra_handle_torque += torque_nm; }

std::array<RigidTransform, 3> DoorWorld::WorldFromDoorLinks() const {
  const WorldState& now = engine_->state;
  auto poses = DoorFromLinks(engine_->door, now.hinge_rad, now.handle_rad);
  for (RigidTransform& pose : poses) pose = engine_->scene.world_from_door * pose;
  return poses;
}

RobotPose DoorWorld::PoseOfRobot() const {
  return engine_->robot.PoseAt(engine_->state.robot_position, engine_->scene.world_from_robot_base);
}

void DoorWorld::Place(const WorldState& state) {
  Require(state.robot_position.size() == engine_->state.robot_position.size() &&
              state.robot_velocity.size() == engine_->state.robot_velocity.size(),
          ErrorCode::kInvalidArgument, "the state is one of a robot with other joints");
  engine_->Place(state);
}

WorldImage DoorWorld::Save() const {
  WorldImage image;
  image.content_ = engine_->Save();
  return image;
}

void DoorWorld::Restore(const WorldImage& image) {
  Require(image.content_ != nullptr, ErrorCode::kInvalidArgument,
          "the image is empty; take one with Save() first");
  engine_->Restore(*image.content_);
}

std::size_t WorldImage::size_bytes() const {
  return content_ == nullptr ? 0 : content_->size_bytes();
}

const std::optional<StateFault>& DoorWorld::fault() const { return engine_->fault; }

std::string DoorWorld::StateHash() const {
  const WorldState& now = engine_->state;
  std::vector<double> numbers(now.robot_position.begin(), now.robot_position.end());
  numbers.insert(numbers.end(), now.robot_velocity.begin(), now.robot_velocity.end());
  numbers.insert(numbers.end(), {now.hinge_rad, now.hinge_rad_s, now.handle_rad, now.handle_rad_s});
  if (engine_->scene.latch.type == LatchType::kBolt)
    numbers.insert(numbers.end(), {now.bolt_m, now.bolt_m_s});
  Sha256 hash;
  hash.Update(std::as_bytes(std::span(numbers)));
  return hash.HexDigest();
}

}  // namespace doorforge

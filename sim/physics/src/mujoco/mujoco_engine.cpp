// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "doorforge/physics/latch_law.h"
#include "doorforge/schemas/bolt.h"

#include "mujoco/mujoco_contacts.h"
#include "mujoco/mujoco_drives.h"
#include "mujoco/mujoco_model.h"
#include "mujoco/mujoco_scene.h"
#include "world/watched_joints.h"
#include "world/world_engine.h"

namespace doorforge::internal {
namespace {

// MuJoCo's contacts are springs that settle in two steps at best; at 1/240 s they would give by
// millimetres in a grip.
constexpr double kLongestStep = 1.0 / 900;  // [s]

int SubstepsOf(const PhysicsConfig& physics) {
  return static_cast<int>(std::ceil(physics.time_step_s / kLongestStep));
}

std::optional<Bolt> BoltOfScene(const Scene& scene, const DoorAsset& door) {
  if (scene.latch.type != LatchType::kBolt) return std::nullopt;
  DoorAsset latched = door;
  latched.latch = scene.latch;
  return BoltOf(latched);
}

/// Forces of a contact report, without what is counted.
void AddForces(const DoorContacts& from, DoorContacts& to) {
  for (const std::size_t side : {0U, 1U}) to.pad_force_n[side] += from.pad_force_n[side];
  to.arm_force_n += from.arm_force_n;
  to.self_force_n += from.self_force_n;
  to.force_on_door_n += from.force_on_door_n;
}

void ScaleForces(double factor, DoorContacts& contacts) {
  for (double& force : contacts.pad_force_n) force *= factor;
  contacts.arm_force_n *= factor;
  contacts.self_force_n *= factor;
  contacts.force_on_door_n *= factor;
}

struct SavedMujoco : SavedWorld {
  std::size_t size_bytes() const override {
    return static_cast<std::size_t>(data->nbuffer) + sizeof(mjData);
  }

  MujocoData data;
  LatchState latch;
  DivergenceDetector watch{{}};
  WatchedStep step;
  DoorContacts contacts;
};

class MujocoEngine final : public WorldEngine {
 public:
  MujocoEngine(const Scene& the_scene, const DoorAsset& the_door, const RobotModel& the_robot,
               const JointVector& start);

  void Step(const RobotCommand& command) override;
  void Place(const WorldState& at) override;
  DoorContacts Contacts() const override { return contacts_; }

 protected:
  std::shared_ptr<SavedWorld> SaveOwn() const override;
  void RestoreOwn(const SavedWorld& image) override;

 private:
  void UpdatePositions();
  void UpdateConstraints();
  void Substep();
  void ApplyTorques();
  void LeadDrives();
  void AddWork(const std::vector<double>& speed_before);
  std::optional<StateFault> CheckTorques() const;
  std::optional<StateFault> Watch(double work_j);
  void ReadState();

  double& Position(int dof) { return at_.data->qpos[dof]; }
  double& Velocity(int dof) { return at_.data->qvel[dof]; }
  double PositionOr0(int dof) const { return dof < 0 ? 0 : at_.data->qpos[dof]; }
  double VelocityOr0(int dof) const { return dof < 0 ? 0 : at_.data->qvel[dof]; }

  std::optional<Bolt> bolt_;
  MujocoSceneText text_;
  MujocoModel at_;
  MujocoContacts touching_;
  MujocoDrives drives_;
  std::vector<int> robot_dofs_;
  int hinge_ = -1;
  int handle_ = -1;
  int bolt_dof_ = -1;
  std::vector<int> joint_of_dof_;  // of the robot; -1 for others
  LatchState latch_;
  DoorContacts contacts_;
  std::vector<double> drive_limit_;
  std::array<double, 2> torque_limit_;
  DivergenceDetector watch_;
  WatchedStep step_;
};

MujocoEngine::MujocoEngine(const Scene& the_scene, const DoorAsset& the_door,
                           const RobotModel& the_robot, const JointVector& start)
    : WorldEngine(the_scene, the_door, the_robot),
      bolt_(BoltOfScene(scene, door)),
      text_(DescribeForMujoco(scene, door, robot, bolt_,
                              scene.physics.time_step_s / SubstepsOf(scene.physics))),
      at_(text_.xml),
      touching_(at_, text_.pieces, robot),
      drives_(scene, robot),
      hinge_(at_.JointNamed("leaf")),
      handle_(at_.JointNamed("handle")),
      bolt_dof_(at_.JointNamed("bolt")),
      joint_of_dof_(static_cast<std::size_t>(at_.model->nv), -1),
      drive_limit_(DriveLimitsOf(robot)),
      torque_limit_(DoorTorqueLimits(door)),
      watch_(WatchedJointsOf(robot, door)) {
  text_ = {};
  for (int i = 0; i < robot.joint_count(); ++i) {
    robot_dofs_.push_back(at_.JointNamed(std::string("robot") + std::to_string(i)));
    joint_of_dof_[static_cast<std::size_t>(robot_dofs_.back())] = i;
    Position(robot_dofs_.back()) = start[i];
  }
  step_.deepest_m = std::numeric_limits<double>::infinity();  // not known before the first step
  step_.position.resize(robot_dofs_.size() + 2);
  step_.velocity.resize(robot_dofs_.size() + 2);
  state.robot_position = start;
  state.robot_velocity = JointVector::Zero(robot.joint_count());
  latch_ = UpdatedLatch(scene.latch, latch_, 0, 0);
  if (bolt_) latch_.locked = IsCaught(*bolt_, door, 0, 0);
  UpdatePositions();
  UpdateConstraints();
  ReadState();
}

void MujocoEngine::UpdatePositions() {
  mjModel* model = at_.model.get();
  mjData* data = at_.data.get();
  Mujoco().kinematics(model, data);
  Mujoco().com_pos(model, data);
  Mujoco().tendon(model, data);
  Mujoco().crb(model, data);
}

void MujocoEngine::UpdateConstraints() {
  mjModel* model = at_.model.get();
  mjData* data = at_.data.get();
  Mujoco().factor_m(model, data);
  Mujoco().collision(model, data);
  touching_.SetFrictions();
  Mujoco().make_constraint(model, data);
  Mujoco().transmission(model, data);
  Mujoco().project_constraint(model, data);
  Mujoco().forward_velocity(model, data);
}

void MujocoEngine::ApplyTorques() {
  mjData* data = at_.data.get();
  for (std::size_t i = 0; i < robot_dofs_.size(); ++i)
    data->qfrc_applied[robot_dofs_[i]] = drives_.torque(static_cast<int>(i));
  const LatchTorques law =
      TorquesOf(scene.latch, latch_, PositionOr0(hinge_), PositionOr0(handle_));
  if (hinge_ >= 0) data->qfrc_applied[hinge_] = law.hinge_nm + extra_hinge_torque;
  if (handle_ >= 0) data->qfrc_applied[handle_] = law.handle_nm + extra_handle_torque;
}

// A drive that wants a speed and has a limit is what MuJoCo calls friction loss, which wants
// standstill: so what its row aims at is led to the speed.
void MujocoEngine::LeadDrives() {
  mjData* data = at_.data.get();
  for (int row = 0; row < data->nefc; ++row) {
    if (data->efc_type[row] != mjCNSTR_FRICTION_DOF) continue;
    const int dof = data->efc_id[row];
    const int joint = joint_of_dof_[static_cast<std::size_t>(dof)];
    const double wanted = drives_.WantedSpeed(joint, Position(dof));
    data->efc_aref[row] = (wanted - Velocity(dof)) / at_.model->opt.timestep;
  }
}

void MujocoEngine::AddWork(const std::vector<double>& speed_before) {
  const mjData& data = *at_.data;
  const double half_step = at_.model->opt.timestep / 2;
  for (int dof = 0; dof < at_.model->nv; ++dof) {
    const double way = (speed_before[static_cast<std::size_t>(dof)] + data.qvel[dof]) * half_step;
    const int joint = joint_of_dof_[static_cast<std::size_t>(dof)];
    if (joint >= 0) {
      step_.work_j +=
          (std::abs(data.qfrc_applied[dof]) + drive_limit_[static_cast<std::size_t>(joint)]) *
          std::abs(way);
    } else {
      // springs of the latch are MuJoCo's own
      const double spring =
          dof == bolt_dof_ ? bolt_->preload_n - bolt_->stiffness_n_per_m * data.qpos[dof] : 0;
      step_.work_j += (data.qfrc_applied[dof] + spring) * way;
    }
  }
}

void MujocoEngine::Substep() {
  mjModel* model = at_.model.get();
  mjData* data = at_.data.get();
  ApplyTorques();
  LeadDrives();
  Mujoco().forward_actuation(model, data);
  Mujoco().forward_acceleration(model, data);
  Mujoco().forward_constraint(model, data);
  const std::vector<double> speed_before(data->qvel, data->qvel + model->nv);
  DoorContacts now = touching_.Report();
  AddForces(contacts_, now);
  contacts_ = std::move(now);
  step_.deepest_m = touching_.deepest_m();
  Mujoco().euler(model, data);
  AddWork(speed_before);
}

std::optional<StateFault> MujocoEngine::CheckTorques() const {
  const mjData& data = *at_.data;
  for (int dof = 0; dof < at_.model->nv; ++dof) {
    if (!std::isfinite(data.qfrc_applied[dof]))
      return StateFault{DivergenceKind::kNotFinite, "torque", data.qfrc_applied[dof], 0,
                        state.time_s};
  }
  const std::array dofs = {hinge_, handle_};
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const double torque = dofs[i] < 0 ? 0 : std::abs(data.qfrc_applied[dofs[i]]);
    if (torque > torque_limit_[i])
      return StateFault{DivergenceKind::kTorque, watch_.joints()[robot_dofs_.size() + i].name,
                        torque, torque_limit_[i], state.time_s};
  }
  return std::nullopt;
}

// Positions must be up to date.
std::optional<StateFault> MujocoEngine::Watch(double work_j) {
  const mjData& data = *at_.data;
  for (std::size_t i = 0; i < step_.position.size(); ++i) {
    const int dof = i < robot_dofs_.size()    ? robot_dofs_[i]
                    : i == robot_dofs_.size() ? hinge_
                                              : handle_;
    step_.position[i] = PositionOr0(dof);
    step_.velocity[i] = VelocityOr0(dof);
  }
  std::vector<double> momentum(static_cast<std::size_t>(at_.model->nv));
  Mujoco().multiply_mass(at_.model.get(), at_.data.get(), momentum.data(), data.qvel);
  step_.kinetic_j = 0;
  for (int dof = 0; dof < at_.model->nv; ++dof)
    step_.kinetic_j += momentum[static_cast<std::size_t>(dof)] * data.qvel[dof] / 2;
  step_.work_j = work_j;
  step_.time_s = state.time_s;
  return watch_.Check(step_);
}

void MujocoEngine::Step(const RobotCommand& command) {
  drives_.Command(command, state.robot_position, state.robot_velocity);
  for (std::size_t i = 0; i < robot_dofs_.size(); ++i)
    at_.model->dof_frictionloss[robot_dofs_[i]] = drives_.limit(static_cast<int>(i));
  UpdatePositions();
  ApplyTorques();
  fault = Watch(0);
  if (!fault) fault = CheckTorques();
  if (fault) return;
  contacts_ = {};
  step_.work_j = 0;
  const int substeps = SubstepsOf(scene.physics);
  for (int i = 0; i < substeps; ++i) {
    UpdateConstraints();
    Substep();
    UpdatePositions();
  }
  ScaleForces(1.0 / substeps, contacts_);
  extra_hinge_torque = 0;
  extra_handle_torque = 0;
  latch_ = UpdatedLatch(scene.latch, latch_, PositionOr0(hinge_), PositionOr0(handle_));
  if (bolt_) latch_.locked = IsCaught(*bolt_, door, PositionOr0(hinge_), PositionOr0(bolt_dof_));
  state.time_s += scene.physics.time_step_s;
  ReadState();
  fault = Watch(step_.work_j);
}

void MujocoEngine::ReadState() {
  for (std::size_t i = 0; i < robot_dofs_.size(); ++i) {
    state.robot_position[static_cast<int>(i)] = Position(robot_dofs_[i]);
    state.robot_velocity[static_cast<int>(i)] = Velocity(robot_dofs_[i]);
  }
  state.hinge_rad = PositionOr0(hinge_);
  state.hinge_rad_s = VelocityOr0(hinge_);
  state.handle_rad = PositionOr0(handle_);
  state.handle_rad_s = VelocityOr0(handle_);
  state.bolt_m = PositionOr0(bolt_dof_);
  state.bolt_m_s = VelocityOr0(bolt_dof_);
  state.locked = latch_.locked;
  state.handle_done = latch_.handle_done;
}

void MujocoEngine::Place(const WorldState& to) {
  const auto put = [&](int dof, double position, double velocity) {
    if (dof < 0) return;
    Position(dof) = position;
    Velocity(dof) = velocity;
  };
  for (std::size_t i = 0; i < robot_dofs_.size(); ++i) {
    const auto joint = static_cast<int>(i);
    put(robot_dofs_[i], to.robot_position[joint], to.robot_velocity[joint]);
  }
  put(hinge_, to.hinge_rad, to.hinge_rad_s);
  put(handle_, to.handle_rad, to.handle_rad_s);
  ReadState();
}

std::shared_ptr<SavedWorld> MujocoEngine::SaveOwn() const {
  auto image = std::make_shared<SavedMujoco>();
  image->data = at_.CopyOfData();
  image->latch = latch_;
  image->watch = watch_;
  image->step = step_;
  image->contacts = contacts_;
  return image;
}

void MujocoEngine::RestoreOwn(const SavedWorld& image) {
  const auto& own = dynamic_cast<const SavedMujoco&>(image);
  Mujoco().copy_data(at_.data.get(), at_.model.get(), own.data.get());
  latch_ = own.latch;
  watch_ = own.watch;
  step_ = own.step;
  contacts_ = own.contacts;
}

}  // namespace

std::unique_ptr<WorldEngine> MakeMujocoEngine(const Scene& scene, const DoorAsset& door,
                                              const RobotModel& robot, const JointVector& start) {
  return std::make_unique<MujocoEngine>(scene, door, robot, start);
}

}  // namespace doorforge::internal

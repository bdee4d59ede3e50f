// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/step_energy_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doorforge::internal {
namespace {

// Speeds that drives, springs and the pull of the arm never come near.
constexpr double kFastestOverDrive = 12;  // where the drive's own limit is 1
constexpr double kFastestWithoutLimit = 30;
constexpr double kFastestSlide = 8;  // at least: a finger that slips off a bar under load is quick
constexpr double kFastestHinge = 20;
constexpr double kFastestHandle = 80;
// What drive and coupling of a finger can do together, see robot_body.cpp.
constexpr double kFingerLimit = 400;
// Torques over the joints' own limits, which an asset may leave at 0 [N m].
constexpr double kMostOverEffort = 10;
constexpr double kLeastHingeEffort = 200;
constexpr double kLeastHandleEffort = 20;

double FastestOf(const RobotJoint& joint) {
  const double fastest =
      joint.velocity > 0 ? kFastestOverDrive * joint.velocity : kFastestWithoutLimit;
  return joint.prismatic ? std::max(fastest, kFastestSlide) : fastest;
}

std::vector<WatchedJoint> JointsOf(const RobotModel& model, const DoorAsset& door) {
  std::vector<WatchedJoint> joints;
  for (const RobotJoint& joint : model.joints())
    joints.push_back({joint.name, joint.prismatic, joint.lower, joint.upper, FastestOf(joint)});
  joints.push_back({"hinge", false, door.hinge.lower_rad, door.hinge.upper_rad, kFastestHinge});
  joints.push_back(
      {"handle", false, door.handle_joint.lower_rad, door.handle_joint.upper_rad, kFastestHandle});
  return joints;
}

std::vector<double> LimitsOfDrives(const RobotModel& model) {
  std::vector<double> limits;
  for (const RobotJoint& joint : model.joints()) limits.push_back(joint.effort);
  for (std::size_t i = limits.size() - 2; i < limits.size(); ++i) limits[i] = kFingerLimit;
  return limits;
}

// Latch, springs and whoever pulls stay far below these limits of hinge and handle.
std::array<double, 2> TorqueLimits(const DoorAsset& door) {
  return {kMostOverEffort * std::max(door.hinge.effort_limit_nm, kLeastHingeEffort),
          kMostOverEffort * std::max(door.handle_joint.effort_limit_nm, kLeastHandleEffort)};
}

double DeepestOverlap(btCollisionDispatcher& dispatcher) {
  double deepest = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int j = 0; j < manifold.getNumContacts(); ++j)
      deepest = std::max<double>(deepest, -manifold.getContactPoint(j).getDistance());
  }
  return deepest;
}

}  // namespace

StepEnergyAudit::StepEnergyAudit(const BulletBody& robot, const BulletBody& door,
                                 const RobotModel& model, const DoorAsset& asset)
    : robot_(robot),
      door_(door),
      drive_limit_(LimitsOfDrives(model)),
      torque_limit_(TorqueLimits(asset)),
      watch_(JointsOf(model, asset)) {
  const auto links =
      static_cast<std::size_t>(robot_.link_count()) + static_cast<std::size_t>(door_.link_count());
  torque_.resize(links);
  speed_before_.resize(links);
  step_.position.resize(drive_limit_.size() + kDoorJoints);
  step_.velocity.resize(step_.position.size());
  // not known before the first step, which may begin with any overlap
  step_.deepest_m = std::numeric_limits<double>::infinity();
}

void StepEnergyAudit::ReadJoints() {
  const int robot_joints = robot_.link_count();
  for (std::size_t i = 0; i < step_.position.size(); ++i) {
    const int index = static_cast<int>(i);
    const BulletBody& body = index < robot_joints ? robot_ : door_;
    const int link = index < robot_joints ? index : index - robot_joints;
    step_.position[i] = body.Position(link);
    step_.velocity[i] = body.Velocity(link);
  }
}

std::optional<StateFault> StepEnergyAudit::BeforeStep(double time_s) {
  step_.time_s = time_s;
  ReadJoints();
  // Nothing moves between steps, so motion that has appeared is a gain out of nothing.
  step_.kinetic_j = robot_.KineticEnergy() + door_.KineticEnergy();
  step_.work_j = 0;
  if (auto fault = watch_.Check(step_)) return fault;
  std::size_t at = 0;
  for (const BulletBody* body : {&robot_, &door_}) {
    for (int link = 0; link < body->link_count(); ++link, ++at) {
      speed_before_[at] = body->Velocity(link);
      torque_[at] = body->AppliedTorque(link);
      if (!std::isfinite(torque_[at]))
        return StateFault{DivergenceKind::kNotFinite, "torque", torque_[at], 0, time_s};
    }
  }
  return CheckTorques(time_s);
}

std::optional<StateFault> StepEnergyAudit::CheckTorques(double time_s) const {
  const std::size_t robot_joints = drive_limit_.size();
  for (std::size_t i = 0; i < torque_limit_.size(); ++i) {
    const double torque = std::abs(torque_[robot_joints + i]);
    if (torque > torque_limit_[i])
      return StateFault{DivergenceKind::kTorque, watch_.joints()[robot_joints + i].name, torque,
                        torque_limit_[i], time_s};
  }
  return std::nullopt;
}

// An impulse does its work at the mean of the speeds before and after. What the robot's drives did
// is not known, but it is no more than their limits allow.
double StepEnergyAudit::WorkOfStep(double time_step_s) const {
  double work = 0;
  std::size_t at = 0;
  for (int link = 0; link < robot_.link_count(); ++link, ++at) {
    const double way = (speed_before_[at] + robot_.Velocity(link)) / 2 * time_step_s;
    work += (std::abs(torque_[at]) + drive_limit_[at]) * std::abs(way);
  }
  for (int link = 0; link < door_.link_count(); ++link, ++at)
    work += torque_[at] * (speed_before_[at] + door_.Velocity(link)) / 2 * time_step_s;
  return work;
}

std::optional<StateFault> StepEnergyAudit::AfterStep(btCollisionDispatcher& dispatcher,
                                                     double time_step_s) {
  ReadJoints();
  step_.deepest_m = DeepestOverlap(dispatcher);
  step_.kinetic_j = robot_.KineticEnergy() + door_.KineticEnergy();
  step_.work_j = WorkOfStep(time_step_s);
  step_.time_s += time_step_s;
  return watch_.Check(step_);
}

}  // namespace doorforge::internal

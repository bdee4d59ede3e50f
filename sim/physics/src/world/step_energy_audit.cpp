// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/step_energy_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "world/watched_joints.h"

namespace doorforge::internal {
namespace {

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
      drive_limit_(DriveLimitsOf(model)),
      torque_limit_(DoorTorqueLimits(asset)),
      watch_(WatchedJointsOf(model, asset)) {
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

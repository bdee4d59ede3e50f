// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/robot_body.h"

#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>

#include "robot/simulated_robot.h"

namespace doorforge::internal {
namespace {

constexpr double kGearForce = 200;

std::vector<BulletLink> LinksOf(const RobotModel& robot, double finger_friction) {
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
    link.least_inertia_kg_m2 = LeastInertiaOf(joint);
    links.push_back(link);
  }
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint >= 0) links[static_cast<std::size_t>(piece.joint)].hulls.push_back(piece.mesh);
  }
  const std::vector<double> frictions = FrictionsOf(robot, finger_friction);
  for (std::size_t i = 0; i < links.size(); ++i) links[i].friction = frictions[i];
  return links;
}

}  // namespace

RobotBody::RobotBody(btMultiBodyDynamicsWorld& world, const Scene& scene, const RobotModel& robot,
                     const JointVector& start)
    : robot_(robot),
      time_step_s_(scene.physics.time_step_s),
      finger_force_n_(scene.physics.finger_force_n),
      body_(world, scene.world_from_robot_base, LinksOf(robot, scene.physics.finger_friction),
            ContactSide::kRobot) {
  if (scene.physics.controller == ArmController::kOperationalSpace) {
    torques_.emplace(robot, scene.world_from_robot_base, scene.physics.operational_space,
                     SimulatedMasses(robot));
  } else {
    AddArmMotors(start);
    if (scene.physics.hand_force_n > 0)
      drive_limits_.emplace(robot, scene.world_from_robot_base, SimulatedMasses(robot),
                            scene.physics.hand_force_n);
  }
  AddFingers();
  for (int i = 0; i < robot_.joint_count(); ++i) {
    const btScalar position = start[i];
    body_.multibody().setJointPosMultiDof(i, &position);
  }
  body_.SyncColliders();
}

void RobotBody::AddArmMotors(const JointVector& start) {
  for (int i = 0; i < robot_.arm_count(); ++i) {
    const double effort = robot_.joint(i).effort;
    auto& motor = body_.Add(
        std::make_unique<btMultiBodyJointMotor>(&body_.multibody(), i, 0, effort * time_step_s_));
    motor.setErp(1);
    motor.setPositionTarget(start[i], kArmPositionGain);
    motor.setVelocityTarget(0, 1);
    arm_motors_.push_back(&motor);
  }
}

void RobotBody::AddFingers() {
  btMultiBody* body = &body_.multibody();
  for (const int side : {0, 1}) {
    auto& motor = body_.Add(std::make_unique<btMultiBodyJointMotor>(
        body, robot_.left_finger() + side, 0, kFingerOpenForce * time_step_s_));
    motor.setErp(1);
    finger_motors_.at(static_cast<std::size_t>(side)) = &motor;
  }
  // couples the fingers: load on one alone would push the pair sideways
  auto& gear = body_.Add(std::make_unique<btMultiBodyGearConstraint>(
      body, robot_.left_finger(), body, robot_.right_finger(), btVector3(0, 0, 0),
      btVector3(0, 0, 0), btMatrix3x3::getIdentity(), btMatrix3x3::getIdentity()));
  gear.setGearRatio(-1);
  gear.setErp(0.1);
  gear.setMaxAppliedImpulse(kGearForce * time_step_s_);
}

void RobotBody::CommandArm(const RobotCommand& command) {
  if (torques_) {
    const ArmVector torques = torques_->Torques(command, Positions(), Velocities());
    for (int i = 0; i < robot_.arm_count(); ++i) body_.multibody().addJointTorque(i, torques[i]);
    return;
  }
  for (int i = 0; i < robot_.arm_count(); ++i) {
    btMultiBodyJointMotor& motor = *arm_motors_[static_cast<std::size_t>(i)];
    motor.setPositionTarget(command.arm_position[i], kArmPositionGain);
    motor.setRhsClamp(command.most_speed ? (*command.most_speed)[i] : SIMD_INFINITY);
  }
  if (!drive_limits_) return;
  const ArmVector limits = command.effort_share * drive_limits_->At(Positions());
  for (int i = 0; i < robot_.arm_count(); ++i)
    arm_motors_[static_cast<std::size_t>(i)]->setMaxAppliedImpulse(limits[i] * time_step_s_);
}

void RobotBody::Command(const RobotCommand& command) {
  CommandArm(command);
  for (btMultiBodyJointMotor* motor : finger_motors_) {
    if (command.close_fingers) {
      // a velocity drive that stalls on the handle presses with just this force
      motor->setPositionTarget(0, 0);
      motor->setVelocityTarget(-kFingerSpeed, 1);
      motor->setMaxAppliedImpulse(finger_force_n_ * time_step_s_);
    } else {
      motor->setPositionTarget(
          command.fingers_open_m.value_or(robot_.joint(robot_.left_finger()).upper),
          kFingerOpeningGain);
      motor->setVelocityTarget(0, 1);
      motor->setRhsClamp(kFingerSpeed);
      motor->setMaxAppliedImpulse(kFingerOpenForce * time_step_s_);
    }
  }
}

JointVector RobotBody::Positions() const {
  JointVector positions(robot_.joint_count());
  for (int i = 0; i < robot_.joint_count(); ++i) positions[i] = body_.Position(i);
  return positions;
}

JointVector RobotBody::Velocities() const {
  JointVector velocities(robot_.joint_count());
  for (int i = 0; i < robot_.joint_count(); ++i) velocities[i] = body_.Velocity(i);
  return velocities;
}

std::string RobotBody::NameOf(const btCollisionObject* object) const {
  for (int i = 0; i < robot_.joint_count(); ++i) {
    if (object == body_.collider(i)) return NameOfBody(robot_, i);
  }
  return {};
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/episode_world.h"

#include <algorithm>
#include <cmath>

#include "doorforge/rollout/base_placement.h"

namespace doorforge::internal {
namespace {

constexpr double kPatience = 0.4;  // [s] for a hand whose commanded pose has arrived
constexpr double kThere = 0.002;   // [m]
// A hand whose force is limited moves no faster: with half the momentum it strikes with half the
// force. Retreating and approaching at 0.15 m/s, 46 reversed doors of the validation side were
// struck with 455 N at most, at this speed with 193.
constexpr double kGentleSpeed = 0.07;  // [m/s]

// A hand that something held up, and that comes free, would else make up for it at 1 m/s.
constexpr double kGentleCatchUp = 0.1;  // [m/s]

HandControllerConfig ControllerFor(const Scene& scene) {
  HandControllerConfig config;
  if (scene.physics.hand_force_n > 0) config.catch_up = kGentleCatchUp;
  return config;
}

}  // namespace

EpisodeWorld::EpisodeWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                           Observer* observer)
    : EpisodeWorld(scene, door, robot, observer, StartPosition(scene, robot)) {}

EpisodeWorld::EpisodeWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                           Observer* observer, const JointVector& start)
    : scene_(scene),
      door_(door),
      robot_(robot),
      observer_(observer),
      world_(scene, door, robot, start),
      facts_(FactsOf(door)),
      memory_{HandController(robot, scene.world_from_robot_base, start, ControllerFor(scene)),
              ForceGovernor(scene.physics.hand_force_n)} {
  scene_.robot = {robot.name(), robot.sha256()};
}

void EpisodeWorld::Step(const RobotCommand& command) {
  if (diverged()) return;
  RobotCommand governed = command;
  governed.effort_share = memory_.governor.share();
  world_.Step(governed);
  ++memory_.step;
  if (diverged()) return;
  NoteContacts(command.close_fingers);
  memory_.peak_hinge_rad = std::max(memory_.peak_hinge_rad, state().hinge_rad);
  memory_.peak_handle_rad = std::max(memory_.peak_handle_rad, state().handle_rad);
  if (observer_ != nullptr && memory_.step % scene_.physics.steps_per_action == 0 &&
      observer_->Follows())
    observer_->Follow(Snapshot(EpisodePhase::kStart));
}

void EpisodeWorld::NoteContacts(bool closing) {
  memory_.contacts = world_.Contacts();
  memory_.forces.Note(contacts(), scene_.physics.time_step_s);
  if (!memory_.governor.IsOn()) return;
  memory_.governor.Note(contacts().force_on_door_n.norm());
  memory_.grip.Note(closing, contacts().AnyPad());
}

void EpisodeWorld::StepHand() {
  if (memory_.grip.lost()) controller().StopAt(state().robot_position);
  Step(controller().Step(state().robot_position, scene_.physics.time_step_s));
}

int EpisodeWorld::StepsIn(double seconds) const {
  return static_cast<int>(std::lround(seconds / scene_.physics.time_step_s));
}

double EpisodeWorld::HandError(const RigidTransform& world_from_hand) const {
  return (world_.PoseOfRobot().world_from_hand.translation() - world_from_hand.translation())
      .norm();
}

bool EpisodeWorld::MoveHand(const RigidTransform& world_from_hand, double speed_m_s) {
  const double distance =
      (world_from_hand.translation() - controller().CommandedHand().translation()).norm();
  if (!(distance < limits().farthest_move_m)) return false;
  const double speed = memory_.governor.IsOn() ? std::min(speed_m_s, kGentleSpeed) : speed_m_s;
  controller().MoveHandTo(world_from_hand, distance / speed);
  const int patience = StepsIn(kPatience);
  for (int waited = 0; waited < patience && !diverged();) {
    StepHand();
    if (!controller().Arrived()) continue;
    ++waited;
    if (HandError(world_from_hand) < kThere) return true;
  }
  return HandError(world_from_hand) < limits().reach_tolerance_m;
}

void EpisodeWorld::NoteGrasp() { memory_.handle_from_hand_at_grasp = HandleFromHand(); }

RigidTransform EpisodeWorld::WorldFromHandle(double handle_rad) const {
  return scene_.world_from_door * DoorFromLinks(door_, state().hinge_rad, handle_rad)[kHandleLink];
}

RigidTransform EpisodeWorld::HandleFromHand() const {
  return WorldFromHandle(state().handle_rad).inverse() * world_.PoseOfRobot().world_from_hand;
}

double EpisodeWorld::Slip() const {
  const Eigen::Vector3d tcp = robot_.hand_from_tcp().translation();
  return (HandleFromHand() * tcp - memory_.handle_from_hand_at_grasp * tcp).norm();
}

double EpisodeWorld::TurnSlip() const {
  return RotationVector(HandleFromHand().linear().transpose() *
                        memory_.handle_from_hand_at_grasp.linear())
      .norm();
}

Hindrance EpisodeWorld::HindranceNow() const {
  return {HandError(memory_.controller.CommandedHand()), contacts(),
          JointAtLimit(robot_, state().robot_position, limits())};
}

PrivilegedState EpisodeWorld::Privileged() const {
  const auto links = world_.WorldFromDoorLinks();
  PrivilegedState privileged;
  privileged.hinge_rad = state().hinge_rad;
  privileged.handle_rad = state().handle_rad;
  privileged.world_from_handle = links[kHandleLink];
  privileged.world_from_hand = world_.PoseOfRobot().world_from_hand;
  privileged.hinge_origin_in_world = links[kLeafLink].translation();
  privileged.hinge_axis_in_world = links[kLeafLink].linear() * door_.hinge.axis;
  privileged.handle_origin_in_world = links[kHandleLink].translation();
  privileged.handle_axis_in_world = links[kHandleLink].linear() * door_.handle_joint.axis;
  privileged.handle_from_hand_at_grasp = memory_.handle_from_hand_at_grasp;
  privileged.door = facts_;
  return privileged;
}

SceneSnapshot EpisodeWorld::Snapshot(EpisodePhase phase) const {
  SceneSnapshot snapshot{world_.PoseOfRobot(), world_.WorldFromDoorLinks(), state().time_s, phase};
  const DoorContacts& contacts = memory_.contacts;
  snapshot.robot_position = state().robot_position;
  snapshot.hinge_rad = state().hinge_rad;
  snapshot.handle_rad = state().handle_rad;
  snapshot.bolt_m = state().bolt_m;
  snapshot.force_n = contacts.pad_force_n[0] + contacts.pad_force_n[1] + contacts.arm_force_n;
  snapshot.net_force_n = contacts.force_on_door_n.norm();
  return snapshot;
}

void EpisodeWorld::Watch(EpisodePhase phase) const {
  if (observer_ != nullptr && !diverged()) observer_->Watch(Snapshot(phase));
}

void EpisodeWorld::Restore(const WorldImage& image, const Memory& memory) {
  world_.Restore(image);
  memory_ = memory;
}

}  // namespace doorforge::internal

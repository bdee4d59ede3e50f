// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/take_hold.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

constexpr double kBack = 0.1;             // [m] clear of the handle
constexpr double kJointsThere = 0.01;     // [rad or m] from the place before the grasp
constexpr double kJointsOnTheWay = 0.05;  // from those before it

// Until all joints are as near to the goal as that, or the budget of steps is used up. Takes the
// steps from the budget.
void MoveJoints(EpisodeWorld& world, const JointVector& goal, double near, int& budget) {
  const double dt = world.scene().physics.time_step_s;
  const int arm = world.robot().arm_count();
  while (budget > 0 && !world.diverged()) {
    --budget;
    const JointVector& now = world.state().robot_position;
    world.Step(world.controller().StepJoints(goal, now, dt, world.limits().reach_speed_fraction));
    const JointVector rest = goal - world.state().robot_position;
    if (rest.head(arm).cwiseAbs().maxCoeff() < near) return;
  }
}

// Keeps the posture, and moves the base away from the door, which lies towards smaller x.
JointVector SteppedBack(const EpisodeWorld& world, JointVector position, double distance_m) {
  const RobotModel& robot = world.robot();
  for (int i = 0; i < robot.base_count(); ++i) {
    const RobotJoint& joint = robot.joint(i);
    if (!joint.prismatic) continue;
    const double away = (world.scene().world_from_robot_base.linear() *
                         joint.parent_from_joint.linear() * joint.axis)
                            .x();
    position[i] = std::clamp(position[i] + distance_m * away, joint.lower, joint.upper);
  }
  return position;
}

// The joints go to the place before the grasp, then the hand straight in.
std::optional<Verdict> ReachHandle(EpisodeWorld& world, ContactLog& log, const GraspPlan& plan) {
  int budget = world.StepsIn(world.limits().reach_time_s);
  if (plan.step_back_m > 0) {
    const JointVector from = world.state().robot_position;
    MoveJoints(world, SteppedBack(world, from, plan.step_back_m), kJointsOnTheWay, budget);
    MoveJoints(world, SteppedBack(world, plan.pregrasp, plan.step_back_m), kJointsOnTheWay, budget);
  }
  MoveJoints(world, plan.pregrasp, kJointsThere, budget);
  world.Watch(EpisodePhase::kReach);
  const RigidTransform goal =
      world.WorldFromHandle(0) * plan.handle_from_tcp * world.robot().hand_from_tcp().inverse();
  if (world.MoveHand(goal, world.limits().approach_speed_m_s)) return std::nullopt;
  log.NoteSelfContact(world.contacts());
  return JudgeReach(world.HandError(goal), world.HindranceNow(), world.limits());
}

// The arm does not yield to a finger that touches first, so it follows that finger.
void CentreHand(EpisodeWorld& world, const DoorContacts& contacts) {
  if (contacts.BothPads() || !contacts.AnyPad()) return;
  RigidTransform hand = world.controller().CommandedHand();
  const double way = contacts.pad_points[0] > 0 ? 1 : -1;
  const double distance = world.limits().centering_speed_m_s * world.scene().physics.time_step_s;
  hand.translation() += way * distance * hand.linear().col(1);
  world.controller().FollowHand(hand);
}

std::optional<Verdict> Close(EpisodeWorld& world, ContactLog& log, bool needs_both_pads) {
  world.controller().close_fingers = true;
  const int budget = world.StepsIn(world.limits().close_time_s);
  const int enough = world.StepsIn(world.limits().both_pads_time_s);
  int both = 0;
  DoorContacts contacts;
  for (int i = 0; i < budget && both < enough && !world.diverged(); ++i) {
    world.StepHand();
    contacts = world.contacts();
    log.NoteSelfContact(contacts);
    both = contacts.BothPads() ? both + 1 : 0;
    CentreHand(world, contacts);
  }
  world.Watch(EpisodePhase::kGrasp);
  world.NoteGrasp();
  if (both >= enough || (!needs_both_pads && contacts.AnyPad())) {
    log.BeginHold(world.step());
    return std::nullopt;
  }
  return JudgeClosing(contacts, world.state().robot_position[world.robot().left_finger()]);
}

}  // namespace

void LetGo(EpisodeWorld& world) {
  RigidTransform hand = world.world().PoseOfRobot().world_from_hand;
  world.controller().close_fingers = false;
  world.controller().StopAt(world.state().robot_position);
  const int opening = world.StepsIn(world.limits().close_time_s);
  for (int i = 0; i < opening && !world.diverged(); ++i) world.StepHand();
  hand.translation() -= kBack * hand.linear().col(2);
  world.MoveHand(hand, world.limits().approach_speed_m_s);
  world.controller().FollowHand(world.world().PoseOfRobot().world_from_hand);
}

GraspPlan PlanOf(const GraspCommand& grasp, const EpisodeWorld& world) {
  RigidTransform world_from_hand = RigidTransform::Identity();
  world_from_hand.linear() = grasp.world_from_hand_rotation;
  RigidTransform world_from_tcp = world_from_hand * world.robot().hand_from_tcp();
  world_from_tcp.translation() =
      grasp.contact_m + kGraspInsertion * grasp.world_from_hand_rotation.col(2);
  const ArmReach reach = PlanReach(world.scene(), world.robot(), world_from_tcp);
  return {world.WorldFromHandle(0).inverse() * reach.world_from_tcp, reach.pregrasp, reach.grasp,
          0};
}

std::optional<Verdict> TakeHold(EpisodeWorld& world, ContactLog& log, const GraspCommand& grasp) {
  world.controller().SetPosture(grasp.plan->grasp);
  world.controller().fingers_open_m = grasp.plan->fingers_open_m;
  std::optional<Verdict> unreached = ReachHandle(world, log, *grasp.plan);
  if (unreached && grasp.both_pads) return unreached;
  const std::optional<Verdict> missed = Close(world, log, grasp.both_pads);
  if (!missed || !unreached || world.diverged()) return missed;
  unreached->detail += "; " + missed->detail;
  return unreached;
}

}  // namespace doorforge::internal

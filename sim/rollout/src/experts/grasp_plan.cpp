// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "doorforge/physics/grasp_probe.h"
#include "doorforge/physics/scene_sampling.h"

#include "experts/arm_reach.h"
#include "experts/grasp_search.h"
#include "experts/push_plan.h"

namespace doorforge {
namespace {

using internal::Reach;
using internal::ReachedGrasp;

// Part of the way from the middle of its range to a limit that the last joint has gone, 0 to 1.
double WristUse(const RobotModel& robot, const JointVector& position) {
  const int wrist = robot.arm_count() - 1;
  const double half = (robot.joint(wrist).upper - robot.joint(wrist).lower) / 2;
  return std::abs(position[wrist] - (robot.joint(wrist).upper - half)) / half;
}

using UseOfArm = std::function<double(const ReachedGrasp&)>;

// The cheapest of all postures is taken, for the grasp and its half turn, its use included.
ReachedGrasp BestReach(const Reach& reach, const RigidTransform& world_from_frame,
                       const RigidTransform& frame_from_tcp, const UseOfArm& use) {
  ReachedGrasp best;
  // the two fingers are alike: half a turn about the approach is the same grasp
  for (const double half_turn : {0.0, std::numbers::pi}) {
    const RigidTransform turned =
        frame_from_tcp * RotationAbout(Eigen::Vector3d::UnitZ(), half_turn);
    for (const JointVector& start : reach.robot.level_postures()) {
      ReachedGrasp reached = internal::ReachFrom(reach, world_from_frame, turned, start);
      reached.cost += use(reached);
      if (reached.cost < best.cost) best = reached;
    }
  }
  return best;
}

// How much of the wrist's range the grasp and the turn of the handle take, and what the arm does
// not reach of the turn.
double UseInTurn(const Reach& reach, const Scene& scene, const DoorAsset& door,
                 const ReachedGrasp& grasp) {
  const double use = WristUse(reach.robot, grasp.grasp);
  if (door.handle_joint.upper_rad <= 0) return use;
  const RigidTransform handle = DoorFromLinks(door, 0, 0)[kHandleLink];
  const double angle = std::min(internal::kTurnCheck, door.handle_joint.upper_rad);
  const RigidTransform turned = DoorFromLinks(door, 0, angle)[kHandleLink];
  JointVector position = grasp.grasp;
  const double missed = reach.Solve(
      scene.world_from_door * turned * handle.inverse() * grasp.frame_from_tcp, position);
  return missed + std::max(use, WristUse(reach.robot, position));
}

}  // namespace

GraspPlan PlanGrasp(const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
  if (IsPushedUpright(door)) return internal::PlanPush(scene, door, robot);
  const RigidTransform door_from_handle = DoorFromLinks(door, 0, 0)[kHandleLink];
  const RigidTransform door_from_grasp =
      door_from_handle * door.handle_from_grasp * scene.grasp_from_noisy_grasp;
  const internal::JudgedGrasp judged =
      internal::SearchGrasp(GraspProbe(door, robot), door, robot, door_from_grasp);
  const Reach reach{robot, scene.world_from_robot_base};
  const ReachedGrasp best =
      BestReach(reach, scene.world_from_door, judged.door_from_tcp,
                [&](const ReachedGrasp& grasp) { return UseInTurn(reach, scene, door, grasp); });
  return {door_from_handle.inverse() * best.frame_from_tcp, best.pregrasp, best.grasp, judged.cost};
}

ArmReach PlanReach(const Scene& scene, const RobotModel& robot,
                   const RigidTransform& world_from_tcp) {
  const Reach reach{robot, scene.world_from_robot_base};
  const ReachedGrasp best =
      BestReach(reach, RigidTransform::Identity(), world_from_tcp,
                [&](const ReachedGrasp& grasp) { return WristUse(robot, grasp.grasp); });
  return {best.frame_from_tcp, best.pregrasp, best.grasp};
}

double GraspCost(const DoorAsset& door, const RobotModel& robot) {
  const RigidTransform door_from_grasp =
      DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp;
  return internal::SearchGrasp(GraspProbe(door, robot), door, robot, door_from_grasp).cost;
}

}  // namespace doorforge

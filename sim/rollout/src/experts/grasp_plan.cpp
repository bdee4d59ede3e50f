// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "doorforge/physics/grasp_probe.h"
#include "doorforge/physics/inverse_kinematics.h"

namespace doorforge {
namespace {

constexpr double kMissCost = 10;       // a pad that meets nothing
constexpr double kUnreachedCost = 20;  // a pose that the arm does not get to
constexpr double kGoodEnough = 0.3;
constexpr double kTurnCheck = 0.7;  // [rad] about 40 degrees, with the press a whole handle range

struct Variation {
  double depth_m = 0;
  double along_m = 0;
  double roll_rad = 0;
};

RigidTransform OffsetGrasp(const RigidTransform& grasp, const Variation& variation) {
  return grasp * Translation({variation.along_m, 0, variation.depth_m}) *
         RotationAbout(Eigen::Vector3d::UnitZ(), variation.roll_rad);
}

// 0 for a flat contact between the middle of the pad and its root.
double ContactCost(const PadContact& contact) {
  const double tilt = 1 - std::abs(contact.normal_in_tcp.y());
  const double beyond_middle = std::max(0.0, contact.point_in_tcp_m.z() - 0.003);
  return 4 * std::max(0.0, tilt - 0.03) + beyond_middle / 0.005 +
         0.1 * std::abs(contact.point_in_tcp_m.x()) / 0.0105;
}

// The open gripper at the grasp and on its way there.
double PassageCost(const GraspProbe& probe, const RigidTransform& door_from_tcp) {
  constexpr double kGap = 0.002;
  double cost = 0;
  for (int i = 0; i <= 4; ++i) {
    const RigidTransform back = door_from_tcp * Translation({0, 0, -kPregraspDistance * i / 4});
    const double missing = kGap - probe.Clearance(back, kGap);
    cost = std::max(cost, std::min(missing / 0.001, 5.0));
  }
  return cost;
}

struct JudgedGrasp {
  RigidTransform door_from_tcp = RigidTransform::Identity();
  double cost = std::numeric_limits<double>::infinity();
};

JudgedGrasp Judge(const GraspProbe& probe, const RobotModel& robot,
                  const RigidTransform& door_from_grasp, const Variation& variation) {
  JudgedGrasp judged;
  judged.door_from_tcp = OffsetGrasp(door_from_grasp, variation);
  const auto left = probe.Close(judged.door_from_tcp, robot.left_finger());
  const auto right = probe.Close(judged.door_from_tcp, robot.right_finger());
  judged.cost = std::abs(variation.depth_m) / 0.1 + std::abs(variation.along_m) / 0.1 +
                std::abs(variation.roll_rad) / 1.75;
  if (!left || !right) {
    judged.cost += kMissCost * ((left ? 0 : 1) + (right ? 0 : 1));
    return judged;
  }
  const double widest = robot.joint(robot.left_finger()).upper - 0.004;
  const double off_center = (left->finger_position_m - right->finger_position_m) / 2;
  const double half_gap = (left->finger_position_m + right->finger_position_m) / 2;
  judged.door_from_tcp.translate(Eigen::Vector3d(0, off_center, 0));
  judged.cost += ContactCost(*left) + ContactCost(*right) +
                 std::max(0.0, half_gap - widest) / 0.001 +
                 PassageCost(probe, judged.door_from_tcp);
  return judged;
}

std::vector<Variation> Variations(Mechanism mechanism) {
  std::vector<Variation> variations;
  const double roll_step = mechanism == Mechanism::kRound ? 0.26 : 0.17;
  for (const double roll : {0.0, roll_step, -roll_step, 2 * roll_step, -2 * roll_step}) {
    for (const double along : {0.0, 0.008, -0.008, 0.02, -0.02}) {
      for (const double depth : {0.0, -0.006, 0.006, -0.012, 0.012})
        variations.push_back({depth, along, roll});
    }
  }
  return variations;
}

JudgedGrasp SearchGrasp(const DoorAsset& door, const RobotModel& robot,
                        const RigidTransform& door_from_grasp) {
  const GraspProbe probe(door, robot);
  JudgedGrasp best;
  for (const Variation& variation : Variations(door.mechanism)) {
    const JudgedGrasp judged = Judge(probe, robot, door_from_grasp, variation);
    if (judged.cost < best.cost) best = judged;
    if (best.cost < kGoodEnough) break;
  }
  return best;
}

// ---- the arm ------------------------------------------------------------------------------------

struct Reach {
  const RobotModel& robot;
  const RigidTransform& world_from_base;

  double Solve(const RigidTransform& world_from_tcp, JointVector& position) const {
    const auto solution =
        SolveInverseKinematics(robot, world_from_base, {world_from_tcp, position}, position);
    position = solution.position;
    return solution.Reached() ? 0 : kUnreachedCost * (1 + solution.position_error_m);
  }
};

// Part of the way from the middle of its range to a limit that the last joint has gone, 0 to 1.
double WristUse(const RobotModel& robot, const JointVector& position) {
  const int wrist = robot.arm_count() - 1;
  const double half = (robot.joint(wrist).upper - robot.joint(wrist).lower) / 2;
  return std::abs(position[wrist] - (robot.joint(wrist).upper - half)) / half;
}

/// A grasp in some frame that is placed in the world, and the arm's way to it.
struct ReachedGrasp {
  RigidTransform frame_from_tcp = RigidTransform::Identity();
  JointVector pregrasp;
  JointVector grasp;
  double cost = std::numeric_limits<double>::infinity();
};

ReachedGrasp ReachFrom(const Reach& reach, const RigidTransform& world_from_frame,
                       const RigidTransform& frame_from_tcp, const JointVector& start) {
  const RigidTransform world_from_tcp = world_from_frame * frame_from_tcp;
  ReachedGrasp reached{frame_from_tcp, start, start, 0};
  JointVector position = start;
  reached.cost += reach.Solve(world_from_tcp * Translation({0, 0, -kPregraspDistance}), position);
  reached.pregrasp = position;
  reached.cost += reach.Solve(world_from_tcp, position);
  reached.grasp = position;
  return reached;
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
      ReachedGrasp reached = ReachFrom(reach, world_from_frame, turned, start);
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
  const double angle = std::min(kTurnCheck, door.handle_joint.upper_rad);
  const RigidTransform turned = DoorFromLinks(door, 0, angle)[kHandleLink];
  JointVector position = grasp.grasp;
  const double missed = reach.Solve(
      scene.world_from_door * turned * handle.inverse() * grasp.frame_from_tcp, position);
  return missed + std::max(use, WristUse(reach.robot, position));
}

}  // namespace

GraspPlan PlanGrasp(const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
  const RigidTransform door_from_handle = DoorFromLinks(door, 0, 0)[kHandleLink];
  const RigidTransform door_from_grasp =
      door_from_handle * door.handle_from_grasp * scene.grasp_from_noisy_grasp;
  const JudgedGrasp judged = SearchGrasp(door, robot, door_from_grasp);
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
  return SearchGrasp(door, robot, door_from_grasp).cost;
}

}  // namespace doorforge

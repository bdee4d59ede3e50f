// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "experts/push_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "doorforge/core/rng.h"
#include "doorforge/physics/inverse_kinematics.h"
#include "doorforge/physics/spawn_collision_checker.h"
#include "doorforge/rollout/opening_expert.h"

#include "experts/arm_reach.h"
#include "experts/grasp_search.h"

namespace doorforge::internal {
namespace {

constexpr int kScatteredPostures = 24;
constexpr double kScatter = 0.5;     // [rad] of each joint of a scattered posture
constexpr double kStepBack = 0.25;   // [m] out of the window, in which the arm begins
constexpr double kGap = 0.005;       // [m] that the robot keeps from frame and leaf
constexpr double kFreeEnough = 1.5;  // the search ends
constexpr double kNearLimit = 0.95;  // of the way from the middle of a joint's range to its end
constexpr std::array<double, 4> kLeans = {0.0, -0.3, 0.3, -0.6};  // [rad] beside the scene's
constexpr std::array<double, 6> kHinges = {0, 0, 0.1, 0.25, 0.45, 0.82};

// The nearest that a joint of the arm comes to a limit: 0 in the middle of its range, 1 at the end.
double ArmUse(const RobotModel& robot, const JointVector& position) {
  double most = 0;
  for (int i = robot.base_count(); i < robot.arm_count(); ++i) {
    const double half = (robot.joint(i).upper - robot.joint(i).lower) / 2;
    most = std::max(most, std::abs(position[i] - (robot.joint(i).upper - half)) / half);
  }
  return most;
}

/// What arm and base go through from the place before the grasp to the open door.
class WayOfPushing {
 public:
  WayOfPushing(const Reach& reach, const Scene& scene, const DoorAsset& door)
      : reach_(reach), scene_(scene), closed_(door, reach.robot) {
    const auto links = DoorFromLinks(door, 0, 0);
    up_ = (links[kLeafLink].linear() * door.hinge.axis).z();
    const double turned = std::min(kTurnCheck, door.latch.handle_done_angle_rad);
    for (std::size_t i = 0; i < kHinges.size(); ++i) {
      const double handle = i == 0 ? turned / 2 : turned;
      stops_.push_back(
          {DoorFromLinks(door, kHinges.at(i), handle)[kHandleLink] * links[kHandleLink].inverse(),
           kHinges.at(i), SpawnCollisionChecker(door, reach.robot, kHinges.at(i), handle)});
    }
  }

  // Above `most` it is not exact.
  double Cost(const ReachedGrasp& grasp, const JudgedGrasp& held, double most) const {
    const double open =
        held.fingers_open_m.value_or(reach_.robot.joint(reach_.robot.left_finger()).upper);
    double cost = grasp.cost + held.cost + CostAt(closed_, grasp.pregrasp, open) +
                  CostAt(closed_, grasp.grasp, open);
    JointVector position = grasp.grasp;
    for (const Stop& stop : stops_) {
      if (cost > most) break;
      const auto solution = SolveInverseKinematics(
          reach_.robot, reach_.world_from_base,
          {scene_.world_from_door * ToolAt(stop, grasp.frame_from_tcp), grasp.grasp}, position);
      position = solution.position;
      cost += solution.Reached() ? 0 : kUnreachedCost * (1 + solution.position_error_m);
      cost += CostAt(stop.checker, position, held.finger_position_m);
    }
    return cost;
  }

 private:
  struct Stop {
    RigidTransform moved;  ///< The handle, from where it is on the closed door.
    double hinge_rad;
    SpawnCollisionChecker checker;
  };

  // The hand keeps its heading, as OpeningExpert does.
  RigidTransform ToolAt(const Stop& stop, const RigidTransform& door_from_tcp) const {
    const RigidTransform tool = stop.moved * door_from_tcp;
    const double yaw =
        OpeningExpertConfig{}.push_yaw_share * stop.hinge_rad * up_ * tool.linear()(2, 1);
    return tool * RotationAbout(Eigen::Vector3d::UnitY(), -yaw);
  }

  double CostAt(const SpawnCollisionChecker& checker, JointVector position,
                double finger_position_m) const {
    position.tail<2>().setConstant(finger_position_m);
    const double use = ArmUse(reach_.robot, position);
    const RobotPose pose = reach_.robot.PoseAt(position, reach_.world_from_base);
    return 0.1 * use + 20 * std::max(0.0, use - kNearLimit) +
           checker.Crowding(pose, scene_.world_from_door, kGap) / kGap;
  }

  const Reach& reach_;
  const Scene& scene_;
  SpawnCollisionChecker closed_;
  std::vector<Stop> stops_;
  double up_ = 1;  // of the hinge's axis
};

// Those of level hands, and others around them.
std::vector<JointVector> Postures(const RobotModel& robot) {
  std::vector<JointVector> postures = robot.level_postures();
  const auto level = static_cast<std::uint32_t>(postures.size());
  Rng rng(1, "push/postures");
  for (int i = 0; i < kScatteredPostures; ++i) {
    JointVector posture = postures[rng.Index(level)];
    for (int k = robot.base_count(); k < robot.arm_count(); ++k)
      posture[k] = std::clamp(posture[k] + kScatter * rng.Normal(), robot.joint(k).lower,
                              robot.joint(k).upper);
    postures.push_back(posture);
  }
  return postures;
}

}  // namespace

GraspPlan PlanPush(const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
  const RigidTransform door_from_handle = DoorFromLinks(door, 0, 0)[kHandleLink];
  const RigidTransform door_from_grasp =
      door_from_handle * door.handle_from_grasp * scene.grasp_from_noisy_grasp;
  const Reach reach{robot, scene.world_from_robot_base};
  const GraspProbe probe(door, robot);
  const WayOfPushing way(reach, scene, door);
  const std::vector<JointVector> postures = Postures(robot);
  ReachedGrasp best;
  JudgedGrasp held;
  for (const double lean : kLeans) {
    const JudgedGrasp judged = SearchGrasp(
        probe, door, robot, door_from_grasp * RotationAbout(Eigen::Vector3d::UnitX(), lean),
        FingerOpening::kAsNeeded);
    for (const double half_turn : {0.0, std::numbers::pi}) {
      const RigidTransform turned =
          judged.door_from_tcp * RotationAbout(Eigen::Vector3d::UnitZ(), half_turn);
      for (const JointVector& posture : postures) {
        ReachedGrasp reached = ReachFrom(reach, scene.world_from_door, turned, posture);
        reached.cost = way.Cost(reached, judged, best.cost);
        if (reached.cost >= best.cost) continue;
        best = reached;
        held = judged;
      }
    }
    if (best.cost < kFreeEnough) break;
  }
  return {door_from_handle.inverse() * best.frame_from_tcp,
          best.pregrasp,
          best.grasp,
          best.cost,
          held.fingers_open_m,
          kStepBack};
}

}  // namespace doorforge::internal

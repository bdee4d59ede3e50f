// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/base_placement.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/physics/inverse_kinematics.h"
#include "doorforge/physics/spawn_collision_checker.h"
#include "doorforge/rollout/grasp_plan.h"

#include "text_format.h"

namespace doorforge {
namespace {

constexpr double kClearOfLeaf = 0.25;  // [m] from the base's axis
constexpr double kFree = 0.1;          // [rad] to every limit: good enough to stop the search
constexpr double kStepBack = 0.02;     // [m]
constexpr int kMostStepsBack = 30;     // the sliders bring the arm back by 1 m

// Where the tool is led along: before the grasp, at it, the handle turned, the door opened.
std::vector<RigidTransform> WayOf(const Scene& scene, const DoorAsset& door) {
  const auto tool = [&](double hinge, double handle) {
    return RigidTransform(scene.world_from_door * DoorFromLinks(door, hinge, handle)[kHandleLink] *
                          door.handle_from_grasp);
  };
  const double turned = std::min(40 * internal::kDegree, door.handle_joint.upper_rad);
  std::vector<RigidTransform> way{tool(0, 0) * Translation({0, 0, -kPregraspDistance}), tool(0, 0),
                                  tool(0, turned)};
  for (const double degrees : {15.0, 30.0, 47.0})
    way.push_back(tool(degrees * internal::kDegree, turned));
  return way;
}

// From the hinge's axis to the grasp, seen from above, in steps of the opening.
bool StandsInTheWay(const Eigen::Vector2d& place, const Scene& scene, const DoorAsset& door) {
  for (const double degrees : {0.0, 25.0, 50.0}) {
    const auto links = DoorFromLinks(door, degrees * internal::kDegree, 0);
    const Eigen::Vector2d hinge =
        (scene.world_from_door * links[kLeafLink].translation()).head<2>();
    const Eigen::Vector2d grasp =
        (scene.world_from_door * links[kHandleLink] * door.handle_from_grasp.translation())
            .head<2>();
    const Eigen::Vector2d leaf = 1.1 * (grasp - hinge);
    const double along =
        std::clamp((place - hinge).dot(leaf) / std::max(leaf.squaredNorm(), 1e-9), 0.0, 1.0);
    if ((hinge + along * leaf - place).norm() < kClearOfLeaf) return true;
  }
  return false;
}

double DistanceToLimits(const RobotModel& robot, const JointVector& position) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = robot.base_count(); i < robot.arm_count(); ++i)
    least =
        std::min({least, position[i] - robot.joint(i).lower, robot.joint(i).upper - position[i]});
  return least;
}

// Poses of the way that are reached, and how freely.
double ScoreOf(const RobotModel& robot, const RigidTransform& world_from_base,
               const std::vector<RigidTransform>& way) {
  double best = 0;
  for (const double half_turn : {0.0, std::numbers::pi}) {
    const RigidTransform roll = RotationAbout(Eigen::Vector3d::UnitZ(), half_turn);
    for (const JointVector& start : robot.level_postures()) {
      JointVector position = start;
      double score = 0;
      double free = kFree;
      for (const RigidTransform& pose : way) {
        const auto solution =
            SolveInverseKinematics(robot, world_from_base, {pose * roll, position}, position);
        if (!solution.Reached()) break;
        position = solution.position;
        free = std::min(free, DistanceToLimits(robot, position));
        score += 1;
      }
      best = std::max(best, score + free);
    }
  }
  return best;
}

// Whether the arm, in its start posture, or the base would be inside the door.
class StartCheck {
 public:
  StartCheck(const RobotModel& robot, const Scene& scene, const DoorAsset& door)
      : robot_(robot), scene_(scene), probe_(door, robot), start_(StartPosition(scene, robot)) {}

  std::optional<StartOverlap> At(const RigidTransform& world_from_base) const {
    return probe_.Find(robot_.PoseAt(start_, world_from_base), scene_.world_from_door);
  }

  /// Throws Error(kInvalidArgument) where the robot would start inside the door.
  void Require(const RigidTransform& world_from_base, const std::string& tried) const {
    const auto overlap = At(world_from_base);
    if (!overlap) return;
    throw Error(
        ErrorCode::kInvalidArgument,
        "scene: door \"" + scene_.door_id + "\": the robot's \"" + overlap->robot +
            "\" would start inside its \"" + overlap->door + "\", " + tried +
            "; no robot can stand in front of a body that reaches so far beyond its handle");
  }

 private:
  const RobotModel& robot_;
  const Scene& scene_;
  SpawnCollisionChecker probe_;
  JointVector start_;
};

RigidTransform StandingPlace(const RobotModel& robot, const Scene& scene, const DoorAsset& door) {
  const StartCheck start(robot, scene, door);
  const std::vector<RigidTransform> way = WayOf(scene, door);
  const Eigen::Vector3d grasp = way[1].translation();
  const double all = static_cast<double>(way.size()) + kFree;
  RigidTransform best = scene.world_from_robot_base;
  double most = -1;
  for (const double ahead : {0.55, 0.65, 0.45, 0.75}) {
    for (const double beside : {0.0, 0.2, -0.2, 0.4, -0.4}) {
      const Eigen::Vector2d place(grasp.x() + ahead, grasp.y() + beside);
      if (StandsInTheWay(place, scene, door)) continue;
      for (const double turn : {0.0, 0.6, -0.6}) {
        const RigidTransform base =
            Translation({place.x(), place.y(), scene.world_from_robot_base.translation().z()}) *
            RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi + turn);
        if (start.At(base)) continue;
        const double score = ScoreOf(robot, base, way);
        if (score > most) {
          most = score;
          best = base;
        }
        if (most >= all) return best;
      }
    }
  }
  start.Require(best, "wherever it reaches the handle");
  return best;
}

// A bulging body reaches to where robots stand before others of its category.
RigidTransform SteppedBack(const RobotModel& robot, const Scene& scene, const DoorAsset& door) {
  const StartCheck start(robot, scene, door);
  RigidTransform base = scene.world_from_robot_base;
  for (int i = 0; i < kMostStepsBack && start.At(base); ++i) base.translation().x() += kStepBack;
  start.Require(base, "0.6 m farther back too");
  return base;
}

}  // namespace

JointVector StartPosition(const Scene& scene, const RobotModel& robot) {
  JointVector start = robot.InitialPosition();
  const int arm_joints = robot.arm_count() - robot.base_count();
  for (std::size_t i = 0; i < scene.arm_start_offset_rad.size(); ++i) {
    if (static_cast<int>(i) < arm_joints)
      start[robot.base_count() + static_cast<Eigen::Index>(i)] += scene.arm_start_offset_rad[i];
  }
  return start;
}

Scene PlaceRobotBase(const RobotModel& robot, Scene scene, const DoorAsset& door) {
  scene.robot = {robot.name(), robot.sha256()};
  scene.world_from_robot_base = robot.base() == RobotBase::kFixed
                                    ? StandingPlace(robot, scene, door)
                                    : SteppedBack(robot, scene, door);
  return scene;
}

}  // namespace doorforge

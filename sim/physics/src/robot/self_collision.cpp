// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/self_collision.h"

#include <algorithm>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "doorforge/core/rng.h"

#include "collision/bullet_body.h"
#include "collision/convex_probe.h"

namespace doorforge::internal {
namespace {

constexpr double kNear = 0.005;
constexpr int kPostures = 32;

using BodyHulls = std::vector<std::vector<ProbeHull>>;

BodyHulls HullsOf(const RobotModel& robot) {
  BodyHulls hulls(static_cast<std::size_t>(robot.joint_count()));
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint >= 0)
      hulls[static_cast<std::size_t>(piece.joint)].push_back(
          MakeProbeHull(piece.mesh, RigidTransform::Identity(), 0.001));
  }
  return hulls;
}

bool Nearer(const std::vector<ProbeHull>& moving, const RigidTransform& fixed_from_moving,
            const std::vector<ProbeHull>& fixed, double distance) {
  for (const ProbeHull& a : moving) {
    const Eigen::AlignedBox3d box = a.box.transformed(fixed_from_moving);
    for (const ProbeHull& b : fixed) {
      if (box.exteriorDistance(b.box) <= distance &&
          Separate(a, fixed_from_moving, b).distance < distance)
        return true;
    }
  }
  return false;
}

std::vector<RobotPose> RandomPoses(const RobotModel& robot) {
  Rng rng(1, "self collision");
  std::vector<RobotPose> poses;
  for (int i = 0; i < kPostures; ++i) {
    JointVector position(robot.joint_count());
    for (int j = 0; j < robot.joint_count(); ++j)
      position[j] = rng.Uniform(robot.joint(j).lower, robot.joint(j).upper);
    poses.push_back(robot.PoseAt(position, RigidTransform::Identity()));
  }
  return poses;
}

}  // namespace

std::vector<std::pair<int, int>> SelfCollisionPairs(const RobotModel& robot) {
  const BodyHulls hulls = HullsOf(robot);
  const RobotPose rest = robot.PoseAt(robot.InitialPosition(), RigidTransform::Identity());
  const std::vector<RobotPose> poses = RandomPoses(robot);
  std::vector<std::pair<int, int>> pairs;
  for (int second = 1; second < robot.joint_count(); ++second) {
    for (int first = 0; first < second; ++first) {
      const auto a = static_cast<std::size_t>(first);
      const auto b = static_cast<std::size_t>(second);
      const int parent = robot.joint(second).parent;
      if (parent == first || parent == robot.joint(first).parent) continue;
      if (hulls[a].empty() || hulls[b].empty()) continue;
      const auto near = [&](const RobotPose& pose, double distance) {
        return Nearer(hulls[b], pose.world_from_body[a].inverse() * pose.world_from_body[b],
                      hulls[a], distance);
      };
      if (near(rest, kNear)) continue;
      const auto overlaps = std::count_if(poses.begin(), poses.end(),
                                          [&](const RobotPose& pose) { return near(pose, 0); });
      const bool next_but_one = parent >= 0 && robot.joint(parent).parent == first;
      if (next_but_one ? overlaps == 0 : overlaps < kPostures / 2)
        pairs.emplace_back(first, second);
    }
  }
  return pairs;
}

bool TouchesItself(const RobotModel& robot, const JointVector& position) {
  const BodyHulls hulls = HullsOf(robot);
  const RobotPose pose = robot.PoseAt(position, RigidTransform::Identity());
  return std::any_of(robot.self_collisions().begin(), robot.self_collisions().end(),
                     [&](const std::pair<int, int>& pair) {
                       const auto a = static_cast<std::size_t>(pair.first);
                       const auto b = static_cast<std::size_t>(pair.second);
                       return Nearer(hulls[b],
                                     pose.world_from_body[a].inverse() * pose.world_from_body[b],
                                     hulls[a], kNear);
                     });
}

SelfCollisionFilter::SelfCollisionFilter(const RobotModel& robot)
    : joint_count_(robot.joint_count()), collide_(PairIndex(joint_count_, 0)) {
  for (const auto& [first, second] : robot.self_collisions())
    collide_[PairIndex(first, second)] = true;
}

bool SelfCollisionFilter::needBroadphaseCollision(btBroadphaseProxy* a,
                                                  btBroadphaseProxy* b) const {
  const bool meet = (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
                    (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0;
  constexpr int kRobot = static_cast<int>(ContactSide::kRobot);
  if (!meet || a->m_collisionFilterGroup != kRobot || b->m_collisionFilterGroup != kRobot)
    return meet;
  const auto link = [](const btBroadphaseProxy* proxy) {
    const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
    const auto* collider = btMultiBodyLinkCollider::upcast(object);
    return collider == nullptr ? -1 : collider->m_link;
  };
  const auto [first, second] = std::minmax({link(a), link(b)});
  return first >= 0 && collide_[PairIndex(first, second)];
}

}  // namespace doorforge::internal

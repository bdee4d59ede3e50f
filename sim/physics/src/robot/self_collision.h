// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "doorforge/physics/robot_model.h"

namespace doorforge::internal {

/// Which bodies of the robot can collide with each other, as pairs of joints, the lower first. Left
/// out are neighbours, bodies on the same parent (fingers), and those that are nearer than 5 mm to
/// each other in the initial posture. Hulls are larger than what they enclose, so those that
/// overlap in half of all postures are left out as well, and neighbours but one that overlap in
/// any: the joint between them has its limits for that.
std::vector<std::pair<int, int>> SelfCollisionPairs(const RobotModel& robot);

/// Whether the bodies of one of these pairs overlap in a posture.
bool TouchesItself(const RobotModel& robot, const JointVector& position);

/// Lets the robot's bodies meet in these pairs only; groups and masks decide about all others.
class SelfCollisionFilter : public btOverlapFilterCallback {
 public:
  explicit SelfCollisionFilter(const RobotModel& robot);

  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;

 private:
  std::size_t PairIndex(int first, int second) const {
    return static_cast<std::size_t>(first) * static_cast<std::size_t>(joint_count_) +
           static_cast<std::size_t>(second);
  }

  int joint_count_;
  std::vector<bool> collide_;
};

}  // namespace doorforge::internal

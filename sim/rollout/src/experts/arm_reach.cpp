// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "experts/arm_reach.h"

#include "doorforge/physics/inverse_kinematics.h"
#include "doorforge/rollout/grasp_plan.h"

namespace doorforge::internal {

double Reach::Solve(const RigidTransform& world_from_tcp, JointVector& position) const {
  const auto solution =
      SolveInverseKinematics(robot, world_from_base, {world_from_tcp, position}, position);
  position = solution.position;
  return solution.Reached() ? 0 : kUnreachedCost * (1 + solution.position_error_m);
}

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

}  // namespace doorforge::internal

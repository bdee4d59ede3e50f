// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/expert_grasp.h"

namespace doorforge {

std::optional<GraspCommand> ExpertGrasp::Choose(const SceneSnapshot& snapshot) {
  GraspCommand chosen;
  chosen.plan = PlanGrasp(scene_, door_, robot_);
  chosen.both_pads = true;
  const RigidTransform world_from_tcp = snapshot.door[kHandleLink] * chosen.plan->handle_from_tcp;
  chosen.world_from_hand_rotation =
      world_from_tcp.linear() * robot_.hand_from_tcp().linear().transpose();
  chosen.contact_m =
      world_from_tcp.translation() - kGraspInsertion * chosen.world_from_hand_rotation.col(2);
  return chosen;
}

}  // namespace doorforge

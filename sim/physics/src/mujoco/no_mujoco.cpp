// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/error.h"

#include "world/world_engine.h"

namespace doorforge::internal {

bool BuiltWithMujoco() { return false; }

void RequireMujoco() {
  throw Error(ErrorCode::kInvalidConfig,
              "this build has no MuJoCo: install libmujoco-dev and configure again, or leave "
              "scene.physics.simulator at bullet");
}

std::unique_ptr<WorldEngine> MakeMujocoEngine(const Scene& /*scene*/, const DoorAsset& /*door*/,
                                              const RobotModel& /*robot*/,
                                              const JointVector& /*start*/) {
  RequireMujoco();
  return nullptr;
}

}  // namespace doorforge::internal

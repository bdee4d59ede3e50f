// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/rollout/grasp_plan.h"

namespace doorforge::internal {

/// PlanGrasp() of a door that is pushed by an upright handle.
GraspPlan PlanPush(const Scene& scene, const DoorAsset& door, const RobotModel& robot);

}  // namespace doorforge::internal

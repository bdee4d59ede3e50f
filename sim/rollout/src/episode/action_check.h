// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/policy.h"

namespace doorforge::internal {

/// Throws Error(kInvalidArgument) that names the number unless all are finite and the matrix is a
/// rotation to 1e-3.
void CheckAction(const Action& action, const std::string& name);
void CheckGrasp(const GraspCommand& grasp);

}  // namespace doorforge::internal

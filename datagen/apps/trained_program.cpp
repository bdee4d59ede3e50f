// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program with networks: doorforge-datagen-trained.

#include "doorforge/learn/instruction_set.h"
#include "doorforge/learn/stage_policy.h"

#include "trained_policy.h"

namespace doorforge {

bool RunsTrainedPolicies() { return true; }

std::unique_ptr<Policy> LoadTrainedPolicy(const TrainedPolicy& policy) {
  return LoadPolicy(policy.folder, {}, NameOf(policy.stage));
}

std::string PolicyArithmetic() { return std::string(NameOf(BestInstructionSet())); }

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program without networks: doorforge-datagen.

#include "doorforge/core/error.h"

#include "trained_policy.h"

namespace doorforge {
namespace {

[[noreturn]] void Refuse(const TrainedPolicy& policy) {
  throw Error(ErrorCode::kInvalidArgument,
              policy.folder.string() + ": this program runs no trained policies");
}

}  // namespace

bool RunsTrainedPolicies() { return false; }

std::unique_ptr<Policy> LoadTrainedPolicy(const TrainedPolicy& policy) { Refuse(policy); }

std::unique_ptr<LearnedGrasp> LoadLearnedGrasp(const TrainedPolicy& policy) { Refuse(policy); }

std::string PolicyArithmetic() { return {}; }

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The rules of this toolkit, a row each.

#include "built_in_policies.h"

namespace doorforge {
namespace {

std::unique_ptr<Policy> MakeOpeningExpert(const PolicySettings& settings) {
  return std::make_unique<OpeningExpert>(settings.opening_expert);
}

std::unique_ptr<Policy> MakeHandleExpert(const PolicySettings& settings) {
  if (!settings.handle_expert) return nullptr;
  return std::make_unique<HandleExpert>(*settings.handle_expert);
}

// An episode that nobody chooses a grasp for has the expert's, which is planned for its robot.
std::unique_ptr<GraspPolicy> MakeExpertGrasp(const PolicySettings&) { return nullptr; }

std::unique_ptr<GraspPolicy> MakeRandomGrasp(const PolicySettings& settings) {
  return std::make_unique<RandomGraspPolicy>(settings.random_grasp);
}

}  // namespace

void internal::AddRules(PolicyRegistry& registry) {
  const std::string expert(kExpertPolicy);
  registry.Add(MotionPolicyRow{Stage::kOpen, expert, MakeOpeningExpert, /*is_own=*/false});
  registry.Add(MotionPolicyRow{Stage::kHandle, expert, MakeHandleExpert, /*is_own=*/false});
  registry.Add(GraspPolicyRow{expert, MakeExpertGrasp, 1, /*is_own=*/false});
  registry.Add(GraspPolicyRow{"random", MakeRandomGrasp, 1, /*is_own=*/false});
}

PolicyRegistry BuiltInPolicies() {
  PolicyRegistry registry;
  for (const auto& add : internal::kBuiltInPolicies) add(registry);
  return registry;
}

}  // namespace doorforge

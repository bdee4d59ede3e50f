// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/registry/policy_registry.h"

namespace doorforge::internal {

// One function a file of policies, which adds their rows. A new file, with its class and its
// function, is declared here, listed below and named in CMakeLists.txt.
void AddRules(PolicyRegistry& registry);
void AddGapartnet(PolicyRegistry& registry);

inline constexpr void (*kBuiltInPolicies[])(PolicyRegistry&) = {AddRules, AddGapartnet};

}  // namespace doorforge::internal

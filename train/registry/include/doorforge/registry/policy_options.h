// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/registry/policy_set_factory.h"

namespace CLI {
class App;
}  // namespace CLI

namespace doorforge {

/// Adds --opener, --handler, --grasper and --whole, which every verb that plays episodes has.
///
/// @param words Their defaults, and afterwards what was given; must live until the arguments are
///     parsed.
void AddPolicyOptions(CLI::App& app, const PolicyRegistry& registry, PolicyWords& words);

/// For who runs trained policies alone: refuses the names of others.
///
/// @param words May be empty: nobody acts at that stage.
/// @param why For the message: "a robot does not know what rules read".
/// @throws Error as PolicyRegistry::Find(), and Error(kInvalidArgument) on the name of a policy.
void RequireTrainedPolicies(const PolicyWords& words, const std::string& why);

}  // namespace doorforge

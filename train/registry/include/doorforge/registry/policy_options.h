// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/registry/policy_set_factory.h"

namespace CLI {
class App;
}  // namespace CLI

namespace doorforge {

/// Adds --opener, --handler and --grasper, which every verb with policies has.
///
/// @param words Their defaults, and afterwards what was given; must live until the arguments are
///     parsed.
void AddPolicyOptions(CLI::App& app, const PolicyRegistry& registry, PolicyWords& words);

/// Goes on accepting an option's earlier name, with a note on standard error that tells the new
/// one. It is not in the help.
///
/// @param value As of the new option, which must have been added before.
void AddEarlierName(CLI::App& app, const std::string& earlier, const std::string& now,
                    std::string& value);

/// The folder of a trained policy, for who runs none but those; `word` may be empty, which gives an
/// empty path.
///
/// @param needs Why, for the message: "on a robot nobody knows what its rules read".
/// @throws Error as PolicyRegistry::Find(), and Error(kInvalidArgument) on the name of a row.
std::filesystem::path TrainedPolicyFolder(Stage stage, const std::string& word,
                                          const std::string& option, const std::string& needs);

}  // namespace doorforge

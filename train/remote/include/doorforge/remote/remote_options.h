// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/registry/policy_registry.h"
#include "doorforge/registry/policy_set_factory.h"
#include "doorforge/remote/remote_policy.h"

namespace CLI {
class App;
}  // namespace CLI

namespace doorforge {

/// Policies of other processes, as a verb is told of them.
struct RemoteOptions {
  std::string policy;   ///< It means what --opener does, and is its earlier name.
  std::string command;  ///< A program that opens.
  std::string timeout = "10";
  std::string chunk = "1";
};

/// Adds --policy, --policy-command, --policy-timeout and --policy-chunk. `options` must live until
/// the arguments are parsed.
void AddRemoteOptions(CLI::App& app, RemoteOptions& options);

/// Gives the program, and each server that `words` name, a row of the registry, and puts the row's
/// name in its place.
///
/// @param default_opener What words.opener is where nobody gave one.
/// @throws Error(kInvalidArgument) if more than one is said to open, or on a number that is none;
///     Error(kMissing) if a server does not answer.
void UseRemotePolicies(const RemoteOptions& options, const std::string& default_opener,
                       PolicyRegistry& registry, PolicyWords& words);

}  // namespace doorforge

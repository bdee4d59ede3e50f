// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/trajectory_policy.h"
#include "doorforge/schemas/hand_policy.h"

namespace doorforge {

/// Who does all of an episode, whatever it is told: a hand that flies, or policies at the stages
/// that carry out what one of them decided.
struct WholePolicy {
  std::unique_ptr<HandPolicy> hand;          ///< Null: `stages` act.
  std::optional<TrajectoryPolicies> stages;  ///< Nothing: `hand` acts.
  std::string weights_sha256;
  HandProvenance provenance;
  /// What it is told that a robot would not know, a phrase each.
  std::vector<std::string> privileges;
};

/// Throws as ReadHandPolicy(), ReadSightPolicy(), ReadFrozenPolicy() and ReadTrajectoryPolicy().
WholePolicy ReadWholePolicy(const std::filesystem::path& folder);

}  // namespace doorforge

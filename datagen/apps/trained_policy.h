// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// A trained policy that acts at a stage instead of the rule, by what its folder says.
struct TrainedPolicy {
  Stage stage = Stage::kOpen;
  std::filesystem::path folder;
  DatasetPolicy identity;
  std::string role;      ///< handler, opener or learner, as its option is called.
  int cloud_points = 0;  ///< Of the clouds that it takes; 0: its record does not say.
};

/// Folders of trained policies that act in the rules' place; empty: the rule.
struct PolicyFolders {
  std::string handler;
  std::string opener;
  std::string learner;  ///< Of the stage that is recorded: drives, and is corrected by the rule.

  bool Any() const { return !handler.empty() || !opener.empty() || !learner.empty(); }
};

/// Reads the record and checks the weights against it, so that a policy that does not fit is
/// refused before any work. Needs no network library.
///
/// @throws Error(kMissing) if there is no policy, Error(kFormat) if it is of another schema or its
///     weights are others than the record's, Error(kInvalidArgument) if it is of another stage.
TrainedPolicy ReadTrainedPolicy(const std::filesystem::path& folder, Stage stage,
                                const std::string& role);

/// A line for config.yaml, so that a policy that has changed is noticed when a run goes on.
std::string TrainedPolicyText(const TrainedPolicy& policy);

/// Lends instances of a trained policy, as many as are in use at once, each to one episode at a
/// time. Safe to use from several threads.
class PolicyPool {
 public:
  explicit PolicyPool(TrainedPolicy policy) : policy_(std::move(policy)) {}

  const TrainedPolicy& policy() const { return policy_; }

  struct GiveBack {
    PolicyPool* pool = nullptr;
    void operator()(Policy* policy) const { pool->Return(std::unique_ptr<Policy>(policy)); }
  };
  /// An instance that goes back to the pool by itself; the pool must outlive it.
  using Loan = std::unique_ptr<Policy, GiveBack>;

  Loan Take();

 private:
  void Return(std::unique_ptr<Policy> policy);

  TrainedPolicy policy_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Policy>> idle_;
};

/// Whether this program can run trained policies. The networks' library takes most of a second to
/// load, so it is linked to a program of its own, `doorforge-datagen-trained`, from the same
/// sources.
bool RunsTrainedPolicies();

/// A new instance that uses one thread. Throws as the loader of policies.
std::unique_ptr<Policy> LoadTrainedPolicy(const TrainedPolicy& policy);

/// What the policies' bytes depend on beside their folders: the instruction set of the networks'
/// loops.
std::string PolicyArithmetic();

}  // namespace doorforge

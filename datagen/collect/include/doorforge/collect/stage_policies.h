// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/collect/stage_config.h"
#include "doorforge/collect/trained_policy.h"
#include "doorforge/core/object_pool.h"
#include "doorforge/registry/policy_registry.h"
#include "doorforge/registry/policy_set_factory.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/policy_set.h"

namespace doorforge {

/// Who acts in the episodes of a collection, in the words of its options.
struct CollectionWords {
  /// Who opens, by a word as in PolicyWords, after the stage "handle" or "grasp" was recorded.
  std::string opener = std::string(kExpertPolicy);
  std::string handler = std::string(kExpertPolicy);  ///< Turns the handle after "grasp".
  /// Folder of a trained policy of the stage that is recorded: it drives and is corrected by the
  /// expert or, at "grasp", takes hold; empty: nobody.
  std::string learner = {};

  bool operator==(const CollectionWords&) const = default;
};

/// The policies of a collection's episodes, and what its records say of them. Safe to use from
/// several threads; not copied, not moved.
class StagePolicies {
 public:
  /// @throws Error as PolicyRegistry::Find() and ReadTrainedPolicy(); Error(kInvalidArgument) if a
  ///     policy takes other clouds than are made, or is given for a stage at which nobody needs it.
  StagePolicies(const StageConfig& config, const CollectionWords& words,
                const PolicyRegistry& registry);
  StagePolicies(const StagePolicies&) = delete;
  StagePolicies& operator=(const StagePolicies&) = delete;

  /// For one episode. Its grasp policy is who takes hold where grasps are sampled.
  ObjectPool<PolicySet>::Lease Take() { return sets_.Take(); }
  /// Whether a policy drives the recorded stage and is corrected.
  bool HasDriver() const { return drivers_ != nullptr; }
  ObjectPool<std::unique_ptr<Policy>>::Lease TakeDriver() { return drivers_->Take(); }

  /// What the policy that turns the handle remembers.
  const RememberedViewConfig& remembered() const { return remembered_; }
  /// Those that act and come from folders.
  std::vector<TrainedPolicy> Trained() const;
  /// A line for each of them, and for each policy that is not of this toolkit, for config.yaml:
  /// with others the bytes are others.
  std::string Text() const;
  /// Who acted: "expert", "sampled", the name of a policy of the registry, or the trained policy's
  /// hashes; who learned, where somebody did.
  nlohmann::ordered_json Record(bool samples_grasp) const;

 private:
  Stage stage_;
  std::optional<TrainedPolicy> learner_;
  PolicySetFactory factory_;
  std::optional<TrainedPolicy> handler_;
  std::optional<TrainedPolicy> opener_;
  RememberedViewConfig remembered_{.resolution_scale = 0};
  ObjectPool<PolicySet> sets_;
  std::unique_ptr<ObjectPool<std::unique_ptr<Policy>>> drivers_;
};

}  // namespace doorforge

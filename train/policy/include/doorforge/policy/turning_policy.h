// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "doorforge/policy/mirroring_policy.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/stage_switch.h"

namespace doorforge {

/// A policy that turns the handle and says when that is done, from what a robot knows of itself.
class TurningPolicy : public Policy, public StageSwitch {
 public:
  /// @param policy Turns the handle; not null.
  /// @param switch_probability As PolicyOptions has it.
  /// @throws Error(kInvalidConfig) if that is not in (0, 1).
  TurningPolicy(std::unique_ptr<Policy> policy, const TurnedClassifier& classifier,
                double switch_probability = PolicyOptions().switch_probability);

  void Reset() override;
  Action Act(const Observation& observation) override;
  /// The last action is not carried out: whether the handle is turned is as before it was asked
  /// for.
  void TakeBack();
  bool UsesPointCloud() const override { return policy_->UsesPointCloud(); }
  bool UsesColors() const override { return policy_->UsesColors(); }

  /// Whether the handle is turned once the actions so far have been carried out: false after
  /// Reset(), and true from the first action on that the classifier gives the probability.
  bool Turned() const override { return turned_; }

 private:
  std::unique_ptr<Policy> policy_;
  MirroringPolicy* mirrors_;  // policy_, where that is one; else null
  TurnedClassifier classifier_;
  double switch_probability_;
  std::optional<Proprioception> first_;
  bool turned_ = false;
  std::optional<Proprioception> first_before_;  // as they were before the last Act()
  bool turned_before_ = false;
};

/// The policy of a folder that `doorforge train handle` wrote, with its classifier.
///
/// @throws Error as LoadPolicy() and ReadTurnedClassifier(); Error(kInvalidArgument) if the folder
///     has no classifier, with the way to get one.
std::unique_ptr<TurningPolicy> LoadTurningPolicy(const std::filesystem::path& folder,
                                                 const PolicyOptions& options = {},
                                                 std::shared_ptr<DoorBelief> belief = nullptr);

}  // namespace doorforge

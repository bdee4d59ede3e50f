// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "doorforge/policy/door_belief.h"
#include "doorforge/registry/policy_registry.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/episode_memory.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/stage_switch.h"

namespace doorforge {

/// A policy that opens or turns the handle, by itself: for those who show it what a robot sees. Who
/// is told of each episode's beginning and of the closed door acts as in a PolicySet, bit by bit.
class LonePolicy : public Policy, public StageSwitch, public EpisodeMemory {
 public:
  /// @param word The name of a policy or the folder of a trained one, as PolicyRegistry::Find().
  /// @param stage kOpen or kHandle; Error(kInvalidArgument) on another.
  /// @throws as PolicySetFactory::Make(); a folder without a classifier is taken: it says nothing.
  LonePolicy(const std::string& word, Stage stage, const PolicyOptions& options = {});

  /// Whether it tells the hinge's side from a picture of the closed door.
  bool WantsPicture() const override { return belief_->WantsPicture(); }
  /// An episode begins.
  ///
  /// @param before What the camera saw of the closed door before the robot came, in the world, as
  ///     many points as there are. Nothing: the hinge is first taken to be on the left, and Act()
  ///     throws if remembered().IsOn().
  void Begin(std::optional<LabelledCloud> before) override;
  /// An episode begins, and nobody has looked.
  void Reset() override { Begin(std::nullopt); }

  /// What its clouds are joined with.
  const RememberedViewConfig& remembered() const { return remembered_; }
  /// The cloud is of what is visible now. Where something is remembered it is joined with what was
  /// seen before, as JoinedCloud() does for the hand of the built-in robot.
  ///
  /// @throws Error(kInvalidArgument) if something is to be remembered and nobody has looked.
  Action Act(const Observation& observation) override;
  /// The cloud holds what is remembered.
  Action ActOnJoined(const Observation& observation) { return policy_->Act(observation); }

  bool UsesPointCloud() const override { return policy_->UsesPointCloud(); }
  bool UsesColors() const override { return policy_->UsesColors(); }
  bool Says() const override { return switch_ != nullptr; }
  bool Turned() const override { return switch_->Turned(); }

 private:
  void Load(const std::string& folder, Stage stage, const PolicyOptions& options);

  std::string word_;
  std::shared_ptr<DoorBelief> belief_;
  std::unique_ptr<Policy> policy_;
  StageSwitch* switch_ = nullptr;  // policy_, where it says when the handle is turned
  RememberedViewConfig remembered_{.resolution_scale = 0};
  Eigen::Vector3d tcp_in_hand_m_ = Eigen::Vector3d::Zero();
  std::optional<LabelledCloud> before_;
};

}  // namespace doorforge

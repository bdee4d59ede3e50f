// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/random_grasp.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/grasp_policy.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// What the policies of a registry are made with; each reads what concerns it.
struct PolicySettings {
  PolicyOptions network;       ///< Trained openers and handlers are made with them.
  GraspOptions network_grasp;  ///< Trained graspers are made with them.
  int network_grasp_resolution =
      GraspCameraConfig{}.resolution_scale;  ///< PolicySet::grasp_resolution_scale of them.
  int grasps = 1;                            ///< PolicySet::grasps.
  RandomGraspConfig random_grasp = {};
  OpeningExpertConfig opening_expert = {};
  /// With it the expert turns the handle decision by decision; without, by the rule of
  /// RunEpisode() in one go.
  std::optional<HandleExpertConfig> handle_expert = {};
};

/// The word of the rule-based expert at every stage.
inline constexpr std::string_view kExpertPolicy = "expert";

/// A policy that opens the door or turns the handle, by name.
struct MotionPolicyRow {
  Stage stage = Stage::kOpen;  ///< kOpen or kHandle.
  std::string name;            ///< The word for it, such as "expert".
  /// A new policy, equal to all others; called from one thread at a time. Null from it, at kHandle:
  /// the rule of RunEpisode() turns the handle.
  std::function<std::unique_ptr<Policy>(const PolicySettings&)> make;
  bool is_own = true;  ///< Not of this toolkit: nobody here knows which doors it has seen.
  RememberedViewConfig remembered{.resolution_scale = 0};  ///< What its clouds are joined with.
};

/// A policy that chooses grasps, by name.
struct GraspPolicyRow {
  std::string name;
  /// Makes a policy as MotionPolicyRow::make does; null from it means the expert's grasp.
  std::function<std::unique_ptr<GraspPolicy>(const PolicySettings&)> make;
  int resolution_scale = 1;  ///< PolicySet::grasp_resolution_scale.
  bool is_own = true;
};

/// What a word for a policy means: a row of the registry, or the folder of a trained one.
struct PolicyChoice {
  std::string word;
  std::filesystem::path folder = {};  ///< Empty: a row.
  std::optional<MotionPolicyRow> motion = {};
  std::optional<GraspPolicyRow> grasp = {};

  bool IsFolder() const { return !folder.empty(); }
  bool IsExpert() const { return !IsFolder() && word == kExpertPolicy; }
  bool IsOwn() const { return (motion && motion->is_own) || (grasp && grasp->is_own); }
  /// For tables and reports: the row's name, or the folder's without those that it lies in.
  std::string Name() const;
};

/// The policies that there are, by stage and name. Those of this toolkit are in
/// BuiltInPolicies(); a program adds its own with one row and passes the registry on to a verb or
/// to a PolicySetFactory.
class PolicyRegistry {
 public:
  /// @throws Error(kInvalidArgument) on a name that is empty, holds a character that is not a
  ///     letter, a digit, "_" or "-", or is taken at that stage.
  void Add(MotionPolicyRow row);
  void Add(GraspPolicyRow row);

  /// The names at a stage, in the order in which they were added.
  std::vector<std::string> Names(Stage stage) const;
  /// What an option takes, for its help: "expert, random, or a folder that `doorforge train grasp`
  /// wrote".
  std::string Choices(Stage stage) const;

  /// What `word` means. A name goes before a folder that is called alike, which "./NAME" names.
  ///
  /// @param option For messages, such as "--opener".
  /// @throws Error(kMissing) if a path leads to no folder; Error(kInvalidArgument) on another word
  ///     that is no name: with the names that there are and the nearest of them.
  PolicyChoice Find(Stage stage, const std::string& word, const std::string& option) const;

 private:
  std::vector<MotionPolicyRow> motion_;
  std::vector<GraspPolicyRow> grasp_;
};

/// The rows of this toolkit: "expert" and the baselines "gapartnet", "gapartnet_clean" and
/// "gapartnet_pull" at every stage, "random" for grasps.
PolicyRegistry BuiltInPolicies();

}  // namespace doorforge

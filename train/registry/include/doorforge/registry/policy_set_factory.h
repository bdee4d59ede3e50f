// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "doorforge/core/named_enum.h"
#include "doorforge/policy/door_belief.h"
#include "doorforge/registry/policy_registry.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/policy_set.h"

namespace doorforge {

/// Who acts at each stage, in the words of the options --opener, --handler and --grasper: the name
/// of a policy, or the folder of a trained one; or, in that of --whole, who does all of it.
struct PolicyWords {
  std::string opener = std::string(kExpertPolicy);
  std::string handler = std::string(kExpertPolicy);
  std::string grasper = std::string(kExpertPolicy);
  std::string whole = {};  ///< A folder that `doorforge reinforce` wrote; empty: nobody does.
};

/// Who says that the handle is turned and opening may begin.
enum class SwitchSource {
  kSimulator,
  /// The policy that turns the handle does, where it says so (StageSwitch); else the simulator.
  kPolicy,
};
inline constexpr NamedValue<SwitchSource> kSwitchSources[] = {
    {SwitchSource::kSimulator, "privileged"}, {SwitchSource::kPolicy, "predicted"}};
constexpr std::span<const NamedValue<SwitchSource>> ValuesOf(SwitchSource) {
  return kSwitchSources;
}

/// Makes sets of policies, all equal.
class PolicySetFactory {
 public:
  /// @throws Error as PolicyRegistry::Find(); Error(kMissing) if words.whole is no folder;
  ///     Error(kInvalidArgument) where somebody is named beside it. What lies in folders is read by
  ///     Make().
  PolicySetFactory(const PolicyRegistry& registry, const PolicyWords& words,
                   PolicySettings settings = {},
                   SwitchSource switch_source = SwitchSource::kPolicy);

  /// A new set. Not to be called by several threads at once.
  ///
  /// @throws Error(kMissing or kFormat) as the readers of trained policies; Error(kInvalidConfig)
  ///     on settings out of range; Error(kInvalidArgument) if a handle policy is to say when the
  ///     handle is turned and cannot, with the way out.
  PolicySet Make() const;

  const PolicyChoice& opener() const { return opener_; }
  const PolicyChoice& handler() const { return handler_; }
  const PolicyChoice& grasper() const { return grasper_; }
  /// The folder of who does all of an episode; empty: nobody does.
  const std::filesystem::path& whole() const { return whole_; }

  /// What the policy that turns the handle remembers of the door, by its record or its row. Throws
  /// as ReadPolicy().
  RememberedViewConfig Remembered() const;

  /// Whether nothing but the rules of the expert acts.
  bool IsExpertAlone() const;
  /// Whether the policy that turns the handle is a trained one, which says when it is turned.
  bool PredictsSwitch() const;

 private:
  void AddOpener(PolicySet& set, const std::shared_ptr<DoorBelief>& belief) const;
  void AddHandler(PolicySet& set, const std::shared_ptr<DoorBelief>& belief) const;
  void AddGrasper(PolicySet& set, const std::shared_ptr<DoorBelief>& belief) const;
  void AddWhole(PolicySet& set) const;

  PolicySettings settings_;
  SwitchSource switch_source_;
  PolicyChoice opener_;
  PolicyChoice handler_;
  PolicyChoice grasper_;
  std::filesystem::path whole_;
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/object_pool.h"
#include "doorforge/registry/policy_set_factory.h"
#include "doorforge/registry/run_policy_set.h"
#include "doorforge/rollout/simulate_doors.h"

namespace doorforge {

/// Runs episodes with the policies of a factory, from several threads at once: as many sets are
/// made as episodes run at a time. Not copied, not moved.
class PolicyEpisodes {
 public:
  /// Throws as PolicySetFactory::Make().
  explicit PolicyEpisodes(PolicySetFactory factory);
  PolicyEpisodes(const PolicyEpisodes&) = delete;
  PolicyEpisodes& operator=(const PolicyEpisodes&) = delete;

  /// @param watcher Sees the episode as well; may be null.
  /// @throws Error(kInvalidArgument) for a robot whose state no policy knows, unless the expert
  ///     acts alone; else as RunPolicySet().
  Episode Run(const EpisodePlace& place, Observer* watcher);

 private:
  PolicySetFactory factory_;
  RememberedViewConfig remembered_;
  ObjectPool<PolicySet> sets_;
};

/// Settings of `doorforge simulate`: those of scenes and expert, and of trained policies.
struct PolicySimulateConfig : SimulateConfig {
  PolicyOptions policy;
  GraspOptions grasp;
  int grasps = 1;  ///< So many times the hand may take hold in an episode, 1 to 10.

  PolicySettings Policies() const {
    return {.network = policy, .network_grasp = grasp, .grasps = grasps, .opening_expert = expert};
  }

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SimulateConfig::VisitFields(self, visit);
    visit("policy", self.policy);
    visit("grasp", self.grasp);
    visit("grasps", self.grasps);
  }
};

/// SimulateDoors() with policies in the expert's place. `config` stands for that of the run.
std::vector<SimulatedEpisode> SimulateDoorsWith(const PolicyWords& words,
                                                const PolicySimulateConfig& config,
                                                SimulationRun run);

}  // namespace doorforge

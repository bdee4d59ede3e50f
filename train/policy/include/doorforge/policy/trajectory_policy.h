// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/trajectory_networks.h"
#include "doorforge/schemas/grasp_policy.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// How a trajectory is chosen and carried out.
struct TrajectoryChoice {
  int contacts = 64;    ///< So many of the handle's visible points are rated, drawn at random;
  int proposals = 100;  ///< at the best so many trajectories, of which the best is taken.
  double opening_rad = 0.95;  ///< What is asked for.
  int actions = 2;            ///< From a waypoint to the next.

  bool operator==(const TrajectoryChoice&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("contacts", self.contacts);
    visit("proposals", self.proposals);
    visit("opening_rad", self.opening_rad);
    visit("actions", self.actions);
  }
};

/// Throws as CheckTrajectoryLook().
void CheckTrajectoryChoice(const TrajectoryChoice& choice, const std::string& path);

/// What somebody decided before anything moved.
struct ChosenTrajectory {
  DoorSight sight;
  TrajectoryTarget target;
  HandTrajectory trajectory;
  float probability = 0;           ///< By the critic, that it opens as far as is asked for.
  std::vector<float> contact_xyz;  ///< The points that were rated [m], world, n x 3,
  std::vector<float> affordance;   ///< and their probabilities, n.
};

/// Nothing where no point of the handle is in view. Points where a tried hand closed (2 cm) are
/// left out as long as there are others. Draws from "trajectory/<episode>/<tried grasps>" of the
/// observation's seed.
std::optional<ChosenTrajectory> ChooseTrajectory(const TrajectoryRater& rater,
                                                 const GraspObservation& seen,
                                                 const TrajectoryLook& look,
                                                 const TrajectoryChoice& choice);

/// Carries out a trajectory action by action, whatever comes of it: an action leads to the next
/// place along its waypoints, and behind the last one the hand stays. Reads where the hand is and
/// looks at nothing.
class TrajectoryReplay : public Policy {
 public:
  /// @param actions From a waypoint to the next, at least 1.
  explicit TrajectoryReplay(int actions) : actions_(actions) {}

  /// The first action begins from where the hand is then.
  void Begin(HandTrajectory trajectory);
  /// It goes on where it was: a stage of the episode is none of the trajectory.
  void Reset() override {}
  /// Throws Error(kInvalidArgument) before Begin().
  Action Act(const Observation& observation) override;
  bool UsesPointCloud() const override { return false; }

 private:
  int actions_;
  HandTrajectory trajectory_;
  std::optional<RigidTransform> start_;  // world from hand
  int acted_ = 0;
};

/// The record of the folder of a policy that says whole trajectories.
struct TrajectoryPolicyRecord {
  TrajectoryNetworks networks;  ///< Without the posterior.
  TrajectoryLook look;
  TrajectoryChoice choice;
  HandProvenance provenance;        ///< `decisions` are its episodes.
  std::string weights_sha256 = {};  ///< Filled in by the reader.
};

/// Writes `policy.safetensors` (in single precision, "proposer", "critic" and "affordance" before
/// ".<layer>.weight" and ".bias") and then `policy.json` (schema doorforge.policy, stage "whole",
/// network "trajectories"). Equal arguments give equal bytes.
void WriteTrajectoryPolicy(const std::filesystem::path& folder,
                           const TrajectoryPolicyRecord& record);

/// Throws as ReadHandPolicy().
TrajectoryPolicyRecord ReadTrajectoryPolicy(const std::filesystem::path& folder);

/// Who acts at the stages of an episode: `grasp` looks once and decides all, the others carry out
/// what it decided.
struct TrajectoryPolicies {
  std::unique_ptr<GraspPolicy> grasp;  ///< Explains its actions.
  std::unique_ptr<Policy> handle;
  std::unique_ptr<Policy> open;
  int resolution_scale = 1;  ///< PolicySet::grasp_resolution_scale.
};
TrajectoryPolicies MakeTrajectoryPolicies(const TrajectoryPolicyRecord& record);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "doorforge/policy/door_belief.h"
#include "doorforge/schemas/grasp_policy.h"

namespace doorforge {

/// The hand follows the handle of a door that is pushed through the doorway, past the jamb, which
/// stops a hand that goes straight in. So this hand is turned half round where its fingers close
/// sideways, until they close up and down, and leans by 20 degrees towards the hinge about that
/// direction. A flap's hand stays as it is.
Eigen::Matrix3d ClearOfTheJamb(const Eigen::Matrix3d& world_from_hand, HingeSide side);

/// Takes hold where another policy does; where the door is believed to be pushed, with a hand that
/// is ClearOfTheJamb(). A grasp that went by another guess than the coming one counts as untried.
/// Keeps the guesses of the episode, so one instance serves one set of policies.
class BeliefGrasp : public GraspPolicy {
 public:
  /// @param policy Not null. @param belief Not null; shared with the policies of a set.
  BeliefGrasp(std::unique_ptr<GraspPolicy> policy, std::shared_ptr<DoorBelief> belief)
      : policy_(std::move(policy)), belief_(std::move(belief)) {}

  std::optional<GraspAction> Choose(const GraspObservation& seen) override;
  bool Explains() const override { return policy_->Explains(); }
  bool UsesColors() const override { return policy_->UsesColors(); }

 private:
  std::unique_ptr<GraspPolicy> policy_;
  std::shared_ptr<DoorBelief> belief_;
  std::vector<DoorGuess> guesses_;  // by which the grasps of this episode went
};

}  // namespace doorforge

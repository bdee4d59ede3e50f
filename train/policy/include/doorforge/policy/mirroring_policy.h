// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/policy/door_belief.h"
#include "doorforge/policy/following_detector.h"
#include "doorforge/policy/stall_detector.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/motion_way.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// A policy that is told which of two ways to take.
class TwoWayPolicy {
 public:
  virtual ~TwoWayPolicy() = default;
  virtual void Reset() = 0;
  virtual Action Act(const Observation& observation, MotionWay way) = 0;
  virtual bool UsesColors() const { return false; }  ///< As Policy::UsesColors().
};

/// How hand and fingers tell what is not told.
struct FeelConfig {
  StallConfig stall;
  FollowingConfig following;
};

/// What one of a set's policies has learned, and who tells it what to take the door for.
struct MirroringRole {
  Stage stage = Stage::kOpen;  ///< kOpen or kHandle.
  /// It has learned both ways of its stage's motion. At kHandle another sense of turning is shown
  /// in the mirror otherwise.
  bool knows_both_ways = false;
  /// Shared with the policies of other stages. Null: doors are hinged left, pulled, and usual.
  std::shared_ptr<DoorBelief> belief = nullptr;
};

/// Plays a policy that has learned doors hinged left, whose handles unlock the usual way, on doors
/// of other kinds: to a door hinged right it shows the mirror image, and to a handle that unlocks
/// the other way the image in a level mirror (mirror.h), and does the mirror image of its answer.
/// It goes by one guess from the first to the last action of a stage. Deterministic as the policy
/// is.
class MirroringPolicy : public Policy {
 public:
  /// @param policy Not null.
  /// @param feel Where the belief leaves something open, it is told of what stalls and of what
  ///     gives way by these.
  /// @throws Error as StallDetector() and FollowingDetector().
  MirroringPolicy(std::unique_ptr<TwoWayPolicy> policy, MirroringRole role,
                  const FeelConfig& feel = {})
      : policy_(std::move(policy)),
        role_(std::move(role)),
        stall_(feel.stall),
        following_(feel.following) {}

  void Reset() override;
  Action Act(const Observation& observation) override;
  bool UsesColors() const override { return policy_->UsesColors(); }
  void TakeBack() { stall_.TakeBack(); }  ///< The last action is not carried out.

  const DoorGuess& guess() const { return guess_; }  ///< The last Act() went by it.
  bool IsStalled() const { return is_stalled_; }     ///< So the belief has been told.
  /// Whether what the policy is shown is turned upside down.
  bool IsUpsideDown() const;
  /// What the policy is shown of the scene by the present guess, for those who judge what it does.
  Observation AsShown(Observation observation) const;
  /// An action in the scene that it is shown, from one in the scene as it is, and the other way.
  Action AsShown(const Action& action) const;

 private:
  MotionWay Way() const;
  bool IsShownAsItIs() const;
  void Feel(const Proprioception& now);

  std::unique_ptr<TwoWayPolicy> policy_;
  MirroringRole role_;
  DoorGuess guess_;
  StallDetector stall_;
  FollowingDetector following_;
  bool has_begun_ = false;
  bool is_stalled_ = false;
};

}  // namespace doorforge

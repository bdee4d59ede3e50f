// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "doorforge/policy/side_finder.h"
#include "doorforge/schemas/motion_way.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// A policy that is told which of two ways to take.
class TwoWayPolicy {
 public:
  virtual ~TwoWayPolicy() = default;
  virtual void Reset() = 0;
  virtual Action Act(const Observation& observation, MotionWay way) = 0;
};

/// When a motion counts as stalled.
struct StallConfig {
  int patience = 3;           ///< So many actions are looked at together.
  double moved_share = 0.35;  ///< The hand did less than this share of what they asked for.
  /// A hand that is farther than this from where it began is not on a wrong way, but held up on the
  /// right one [m].
  double within_m = 0.05;
  /// This is a share like `moved_share`, of the shifts along the world's y alone, and counts where
  /// there is doubt about the side: a leaf that is hinged on the other side takes the hand along
  /// the other arc. With 0 it is not looked at, since a hand that lags looks alike.
  double sideways_share = 0;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("patience", self.patience);
    visit("moved_share", self.moved_share);
    visit("within_m", self.within_m);
    visit("sideways_share", self.sideways_share);
  }
};

/// Says from the hand's own motion whether what was asked of it leads anywhere. Shift and turn are
/// weighed together, a turn by the way that a point at 0.1 m from the hand goes with it.
class StallDetector {
 public:
  explicit StallDetector(const StallConfig& config) : config_(config) {}

  void Reset();
  /// How far the hand is from where the first action was asked for [m].
  double WayFromStart(const Proprioception& now) const;
  /// Notes what is asked for where the hand is now, after the answer to what was asked before.
  void Ask(const Proprioception& now, const Action& action);
  /// What was asked for last is not carried out.
  void TakeBack() { before_.reset(); }
  /// Whether the hand did too small a share of the last `patience` actions; false while there are
  /// fewer. The share is the projection of what the hand did on what was asked.
  bool Stalls(const Proprioception& now);
  /// Whether there are `patience` actions to look at.
  bool IsFull() const;
  /// Whether the last `patience` actions asked for a way to one side and the hand did too little of
  /// it, while it has not gone far yet. For after Stalls().
  bool IsHeldSideways(const Proprioception& now) const;

 private:
  struct Share {
    double done = 0;
    double asked = 0;
    double sideways_done = 0;
    double sideways_asked = 0;
  };
  void Answer(const Proprioception& now);
  Share Sum() const;

  StallConfig config_;
  std::optional<Proprioception> start_;
  std::optional<Proprioception> before_;
  Action asked_;
  std::deque<Share> shares_;
};

/// Which side the hinge is taken to be on, and which way the motion takes.
struct MotionGuess {
  HingeSide side = HingeSide::kLeft;
  MotionWay way = MotionWay::kUsual;

  friend bool operator==(const MotionGuess&, const MotionGuess&) = default;
};

/// Plays a policy that has learned doors hinged left on doors of either side: to a door hinged
/// right it shows the mirror image, see mirror.h, and does the mirror image of its answer. Begins
/// with what the SideFinder says and the usual way. Where that leads nowhere it tries the next
/// guess, the first again after the last: it is told nothing of the door but what it sees and
/// feels. Deterministic as the policy is.
class TryingPolicy : public Policy {
 public:
  /// @param policy Not null.
  /// @param ways Which ways it has learned, in the order in which they are tried; not empty.
  /// @param finder Shared with the policies of other stages. Null: doors are hinged left.
  /// @throws Error(kInvalidConfig) unless patience is 1 to 100 and the share 0 to 1.
  TryingPolicy(std::unique_ptr<TwoWayPolicy> policy, const StallConfig& config,
               std::vector<MotionWay> ways, std::shared_ptr<SideFinder> finder);

  void Reset() override;
  Action Act(const Observation& observation) override;
  void TakeBack() { stall_.TakeBack(); }  ///< The last action is not carried out.

  const MotionGuess& guess() const { return guess_; }  ///< The last Act() went by it.
  bool changed() const { return changed_; }  ///< The last Act() went by another than that before.
  /// What the policy is shown of the scene by the present guess, for those who judge what it does.
  Observation AsShown(Observation observation) const;
  /// An action in the scene that it is shown, from one in the scene as it is, and the other way.
  Action AsShown(const Action& action) const;

 private:
  void Begin(const Observation& observation);
  bool IsInDoubt() const;  // about the side

  std::unique_ptr<TwoWayPolicy> policy_;
  StallDetector stall_;
  std::vector<MotionWay> ways_;
  std::shared_ptr<SideFinder> finder_;
  std::vector<MotionGuess> guesses_;  // of this episode; empty before its first action
  std::size_t tried_ = 0;
  std::uint64_t episode_ = 0;  // SideFinder::episode() of the last stage that began
  MotionGuess guess_;
  bool changed_ = false;
};

}  // namespace doorforge

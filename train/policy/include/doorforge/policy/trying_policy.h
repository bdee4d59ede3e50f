// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "doorforge/schemas/motion_way.h"
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

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("patience", self.patience);
    visit("moved_share", self.moved_share);
  }
};

/// Says from the hand's own motion whether what was asked of it leads anywhere. Shift and turn are
/// weighed together, a turn by the way that a point at 0.1 m from the hand goes with it.
class StallDetector {
 public:
  explicit StallDetector(const StallConfig& config) : config_(config) {}

  void Reset();
  /// Notes what is asked for where the hand is now, after the answer to what was asked before.
  void Ask(const Proprioception& now, const Action& action);
  /// What was asked for last is not carried out.
  void TakeBack() { before_.reset(); }
  /// Of the last `patience` actions; false while there are fewer. The share is the projection of
  /// what the hand did on what was asked.
  bool Stalls(const Proprioception& now);

 private:
  struct Share {
    double done = 0;
    double asked = 0;
  };
  void Answer(const Proprioception& now);

  StallConfig config_;
  std::optional<Proprioception> before_;
  Action asked_;
  std::deque<Share> shares_;
};

/// Tries the usual way first. Where that leads nowhere it goes the other way, and back again where
/// that does not either: it is told nothing of the door but what it feels. Deterministic as the
/// policy is.
class TryingPolicy : public Policy {
 public:
  /// @param policy Not null.
  /// @throws Error(kInvalidConfig) unless patience is 1 to 100 and the share 0 to 1.
  TryingPolicy(std::unique_ptr<TwoWayPolicy> policy, const StallConfig& config);

  void Reset() override;
  Action Act(const Observation& observation) override;
  void TakeBack() { stall_.TakeBack(); }  ///< The last action is not carried out.

  MotionWay way() const { return way_; }     ///< It was taken by the last Act().
  bool changed() const { return changed_; }  ///< The last Act() took another way than that before.

 private:
  std::unique_ptr<TwoWayPolicy> policy_;
  StallDetector stall_;
  MotionWay way_ = MotionWay::kUsual;
  bool changed_ = false;
};

}  // namespace doorforge

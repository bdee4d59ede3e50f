// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "doorforge/schemas/policy.h"

namespace doorforge {

/// When a motion counts as stalled.
struct StallConfig {
  int patience = 3;  ///< So many actions are looked at together.
  /// The hand did less than this share of what they asked for. On the validation side no hand of
  /// 70 that turned the handle and opened did less than 0.72 of three actions; half of those that
  /// turned it the wrong way did less than 0.65, the others slipped.
  double moved_share = 0.65;
  /// A hand that is farther than this from where it began is not on a wrong way, but held up on the
  /// right one, or slipping [m].
  double within_m = 0.02;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("patience", self.patience);
    visit("moved_share", self.moved_share);
    visit("within_m", self.within_m);
  }
};

/// Says from the hand's own motion whether what was asked of it leads anywhere. Shift and turn are
/// weighed together, a turn by the way that a point at 0.1 m from the hand goes with it.
class StallDetector {
 public:
  /// @throws Error(kInvalidConfig) unless patience is 1 to 100 and the share 0 to 1.
  explicit StallDetector(const StallConfig& config);

  void Reset();
  /// Notes what is asked for where the hand is now, after the answer to what was asked before.
  void Ask(const Proprioception& now, const Action& action);
  /// What was asked for last is not carried out.
  void TakeBack() { before_.reset(); }
  /// Whether the hand did too small a share of the last `patience` actions; false while there are
  /// fewer. The share is the projection of what the hand did on what was asked.
  bool Stalls(const Proprioception& now);

 private:
  struct Share {
    double done = 0;
    double asked = 0;
  };
  void Answer(const Proprioception& now);

  StallConfig config_;
  std::optional<Proprioception> start_;
  std::optional<Proprioception> before_;
  Action asked_;
  std::deque<Share> shares_;
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace doorforge::internal {

/// What is known of one decision of a stepper once it has played.
struct PpoDecision {
  double reward = 0;
  double value = 0;       ///< Of the state before it, by the critic.
  double next_value = 0;  ///< Of the state after it; 0 where the episode came to its own end.
  bool ends = false;      ///< The next decision belongs to another episode.
};

/// Generalised advantage estimation (Schulman et al. 2016): A_t = sum over l of (gamma lambda)^l
/// delta_{t+l} up to the end of the episode, delta_t = reward + gamma next_value - value. One
/// number a decision.
std::vector<double> AdvantagesOf(std::span<const PpoDecision> decisions, double gamma,
                                 double lambda);

}  // namespace doorforge::internal

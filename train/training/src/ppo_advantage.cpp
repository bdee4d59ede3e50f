// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "ppo_advantage.h"

namespace doorforge::internal {

std::vector<double> AdvantagesOf(std::span<const PpoDecision> decisions, double gamma,
                                 double lambda) {
  std::vector<double> advantages(decisions.size());
  double following = 0;
  for (std::size_t i = decisions.size(); i-- > 0;) {
    const PpoDecision& decision = decisions[i];
    if (decision.ends) following = 0;
    const double delta = decision.reward + gamma * decision.next_value - decision.value;
    following = delta + gamma * lambda * following;
    advantages[i] = following;
  }
  return advantages;
}

}  // namespace doorforge::internal

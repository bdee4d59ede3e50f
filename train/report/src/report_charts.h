// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "doorforge/report/report.h"

// The charts of a report as SVG.

namespace doorforge::internal {

/// A bar from 0 to the rate with its interval as a whisker; `reference` is marked by a tick, unless
/// it has no episodes.
std::string RateBar(const SuccessRate& rate, const SuccessRate& reference);

/// Share of episodes whose door passed an angle, over the angle, for the policy and the reference;
/// intervals at the four thresholds of the paper.
std::string AngleChart(std::span<const EvaluatedEpisode> episodes,
                       std::span<const EvaluatedEpisode> reference);

/// Training and validation loss over the epochs.
std::string LossChart(const LossCurve& loss);

}  // namespace doorforge::internal

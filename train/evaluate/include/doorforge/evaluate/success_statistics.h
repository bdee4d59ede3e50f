// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/evaluate/evaluated_episode.h"

namespace doorforge {

/// A share of episodes with its Wilson score interval (Wilson 1927) at 95 % confidence. The
/// interval takes episodes as independent; several episodes on one door are not quite, so read it
/// together with the number of doors.
struct SuccessRate {
  int successes = 0;
  int episodes = 0;
  double rate = 0;  ///< successes / episodes, 0..1; 0 where there are no episodes.
  double low = 0;   ///< Lower end of the interval, 0..rate; 0 where there are no episodes.
  double high = 1;  ///< Upper end of the interval, rate..1; 1 where there are no episodes.
};

/// Throws Error(kInvalidArgument) unless 0 <= successes <= episodes.
SuccessRate WilsonRate(int successes, int episodes);

/// Success of each seed by itself: UniDoorManip repeats its evaluation over 3 seeds and reports
/// mean and variance (Section 6 of the paper).
struct SeedSpread {
  std::vector<std::uint64_t> seeds;  ///< Ascending, those that have episodes.
  std::vector<double> rates;         ///< Success rate of each seed.
  double mean = 0;                   ///< Of `rates`; 0 where there are none.
  double variance = 0;               ///< Unbiased (n - 1); 0 for fewer than two seeds.
};

/// Share of episodes whose greatest hinge angle is larger than `angle_rad`, whether the gripper
/// still held on or not.
struct AngleSuccess {
  double angle_rad = 0;
  SuccessRate success;
};

/// UniDoorManip's thresholds: 0.1 rad, 15, 30 and 45 degrees.
inline constexpr std::array<double, 4> kSuccessAngles = {0.1, 0.2617993877991494,
                                                         0.5235987755982988, 0.7853981633974483};

struct SuccessSummary {
  SuccessRate handle_done;               ///< Handle held, turned and unlocked.
  SuccessRate opened;                    ///< Episodes that ended as EpisodeOutcome::kOpened.
  SeedSpread over_seeds;                 ///< Of the same.
  std::vector<AngleSuccess> over_angle;  ///< At kSuccessAngles, in order.
  double median_opening_s = 0;  ///< Simulated time of episodes that opened; 0 where none did.
  double median_force_n = 0;    ///< Of the episodes' peak forces; 0 where there are no episodes.
  double peak_force_n = 0;      ///< Greatest of them.
  std::array<int, kEpisodeOutcomeCount> outcomes{};  ///< Episodes by EpisodeOutcome.
};

/// A way in which episodes failed.
struct FailureCause {
  std::string name;       ///< As CauseOf().
  int episodes = 0;       ///< How many, at least 1.
  std::size_t first = 0;  ///< Index of the first of them.
};

/// The causes that occur, the most frequent first; of equally frequent ones whose first episode is
/// earlier.
std::vector<FailureCause> CausesOf(std::span<const EvaluatedEpisode> episodes);

/// The order of episodes does not matter; no episodes give a summary of zeros.
SuccessSummary Summarise(std::span<const EvaluatedEpisode> episodes);

/// The episodes of one category, in their order.
std::vector<EvaluatedEpisode> OfCategory(std::span<const EvaluatedEpisode> episodes,
                                         Category category);

/// Categories that occur, in the order of the enumeration.
std::vector<Category> CategoriesOf(std::span<const EvaluatedEpisode> episodes);

}  // namespace doorforge

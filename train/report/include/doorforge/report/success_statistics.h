// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/wilson_interval.h"
#include "doorforge/report/evaluated_episode.h"

namespace doorforge {

/// A share of episodes with an interval at 95 % confidence.
struct SuccessRate {
  int successes = 0;
  int episodes = 0;
  double rate = 0;    ///< successes / episodes, 0..1; 0 where there are no episodes.
  double low = 0;     ///< Lower end of the interval, 0..rate; 0 where there are no episodes.
  double high = 1;    ///< Upper end of the interval, rate..1; 1 where there are no episodes.
  double trials = 0;  ///< Independent trials that the interval stands for, see ClusteredRate().
};

/// A trial for ClusteredRate(): what was tried and how much of it succeeded.
struct ClusteredTrial {
  std::string body;
  std::string handle;
  double success = 0;  ///< 0 or 1; in between for the mean of several policies on one trial.
};

/// The share of successes, with an interval for other bodies and handles of the kind.
///
/// Trials with a body or a handle in common are not independent: mostly it is the same handle that
/// fails with every body and every seed. So bodies and handles are resampled, both at a time, and
/// not trials (the pigeonhole bootstrap: Owen, The pigeonhole bootstrap, Annals of Applied
/// Statistics 2007; 1,000 times, always the same). The variance over the resamples says how many
/// independent trials would have varied as much, and Wilson's interval is taken for so many (Korn
/// and Graubard, Confidence intervals for proportions with small expected number of positive counts
/// estimated from survey data, Survey Methodology 1998). They are never more than the doors,
/// pairs of a body and a handle, also where all trials end alike and resampling shows no variance.
///
/// The order of the trials does not matter.
SuccessRate ClusteredRate(std::span<const ClusteredTrial> trials);

/// How much more often one policy succeeds than another on the same trials.
struct ClusteredDifference {
  double mean = 0;  ///< The differences' mean, in [-1, 1].
  double low = 0;   ///< The 95 % interval of the mean begins there.
  double high = 0;  ///< Its upper end.
  int trials = 0;

  /// Whether the interval leaves out 0.
  bool IsSignificant() const { return low > 0 || high < 0; }
};

/// The mean of paired differences, each in ClusteredTrial::success and in [-1, 1], with the 2.5th
/// and the 97.5th percentile over the resamples of ClusteredRate(). The order of the trials does
/// not matter; no trials give zeros.
ClusteredDifference MeanDifference(std::span<const ClusteredTrial> trials);

/// Success of each seed by itself: UniDoorManip repeats its evaluation over 3 seeds and reports
/// mean and variance (Section 5 of the paper).
struct SeedSpread {
  std::vector<std::uint64_t> seeds;  ///< Ascending, those that have episodes.
  std::vector<double> rates;         ///< Success rate of each seed.
  double mean = 0;                   ///< It is that of `rates`; 0 where there are none.
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

/// Limits of the net force on a door [N] for which success is told.
inline constexpr std::array<double, 3> kForceLimits = {60, 100, 150};

/// Success of those episodes that did not pass a force.
struct ForceSuccess {
  double limit_n = 0;
  SuccessRate success;
};

struct SuccessSummary {
  SuccessRate handle_turned;             ///< Handle held, turned and unlocked.
  SuccessRate opened;                    ///< Episodes that ended as EpisodeOutcome::kOpened.
  SeedSpread over_seeds;                 ///< It tells how the seeds differ.
  std::vector<AngleSuccess> over_angle;  ///< At kSuccessAngles, in order.
  double median_opening_s = 0;  ///< Simulated time of episodes that opened; 0 where none did.
  double median_force_n = 0;  ///< It is that of the episodes' peaks; 0 where there are no episodes.
  double peak_force_n = 0;    ///< Greatest of them.
  double median_net_force_n = 0;  ///< It is the median of EvaluatedEpisode::peak_net_force_n,
  double most_net_force_n = 0;    ///< which 99 % of the episodes do not pass,
  double peak_net_force_n = 0;    ///< and no episode.
  /// Opened without passing a net force, at kForceLimits, in order.
  std::vector<ForceSuccess> within_force;
  std::array<int, kEpisodeOutcomeCount> outcomes{};  ///< Episodes by EpisodeOutcome.
};

/// A way in which episodes failed.
struct FailureCause {
  std::string name;       ///< CauseOf() gives it.
  int episodes = 0;       ///< How many, at least 1.
  std::size_t first = 0;  ///< Index of the first of them.
};

/// The causes that occur, the most frequent first; of equally frequent ones whose first episode is
/// earlier.
std::vector<FailureCause> CausesOf(std::span<const EvaluatedEpisode> episodes);

/// The order of episodes does not matter; no episodes give a summary of zeros.
SuccessSummary Summarise(std::span<const EvaluatedEpisode> episodes);

/// Which of the episodes are meant: all, those of a category, or of its doors with or without a
/// latch.
struct EpisodeGroup {
  std::optional<Category> category = {};
  std::optional<bool> latched = {};

  bool operator==(const EpisodeGroup&) const = default;
};

/// "overall", "car", "storagefurniture/latched".
std::string NameOf(const EpisodeGroup& group);

/// All, then each category that occurs, in the order of the enumeration; after a category with
/// doors of both kinds those with and those without a latch.
std::vector<EpisodeGroup> GroupsOf(std::span<const EvaluatedEpisode> episodes);

/// The episodes of a group, in their order.
std::vector<EvaluatedEpisode> OfGroup(std::span<const EvaluatedEpisode> episodes,
                                      const EpisodeGroup& group);

/// The episodes of one category, in their order.
std::vector<EvaluatedEpisode> OfCategory(std::span<const EvaluatedEpisode> episodes,
                                         Category category);

/// Categories that occur, in the order of the enumeration.
std::vector<Category> CategoriesOf(std::span<const EvaluatedEpisode> episodes);

}  // namespace doorforge

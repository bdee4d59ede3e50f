// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/success_statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr double kNormalQuantile975 = 1.959963984540054;

SeedSpread SpreadOf(std::span<const EvaluatedEpisode> episodes) {
  std::map<std::uint64_t, std::pair<int, int>> opened_of_all;
  for (const EvaluatedEpisode& episode : episodes) {
    auto& [opened, all] = opened_of_all[episode.seed];
    opened += episode.outcome == EpisodeOutcome::kOpened ? 1 : 0;
    ++all;
  }
  SeedSpread spread;
  for (const auto& [seed, counts] : opened_of_all) {
    spread.seeds.push_back(seed);
    spread.rates.push_back(static_cast<double>(counts.first) / counts.second);
  }
  const auto n = static_cast<double>(spread.rates.size());
  for (const double rate : spread.rates) spread.mean += rate / n;
  for (const double rate : spread.rates) {
    if (n > 1) spread.variance += (rate - spread.mean) * (rate - spread.mean) / (n - 1);
  }
  return spread;
}

// The upper of the two in the middle of an even number; 0 of none.
double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

SuccessRate WilsonRate(int successes, int episodes) {
  Require(successes >= 0 && successes <= episodes, ErrorCode::kInvalidArgument,
          std::to_string(successes) + " successes of " + std::to_string(episodes) +
              " episodes: expected 0 <= successes <= episodes");
  if (episodes == 0) return {};
  const double n = episodes;
  const double p = successes / n;
  const double z2 = kNormalQuantile975 * kNormalQuantile975;
  const double center = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half =
      kNormalQuantile975 / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  // at 0 and n successes one end is exactly 0 or 1; rounding must not say otherwise
  const double low = successes == 0 ? 0 : std::max(0.0, center - half);
  const double high = successes == episodes ? 1 : std::min(1.0, center + half);
  return {successes, episodes, p, low, high};
}

SuccessSummary Summarise(std::span<const EvaluatedEpisode> episodes) {
  SuccessSummary summary;
  for (const EvaluatedEpisode& episode : episodes)
    ++summary.outcomes.at(static_cast<std::size_t>(episode.outcome));
  const int all = static_cast<int>(episodes.size());
  summary.opened = WilsonRate(summary.outcomes[static_cast<int>(EpisodeOutcome::kOpened)], all);
  summary.over_seeds = SpreadOf(episodes);
  std::vector<double> times;
  std::vector<double> forces;
  int done = 0;
  for (const EvaluatedEpisode& episode : episodes) {
    done += episode.handle_done ? 1 : 0;
    forces.push_back(episode.peak_force_n);
    if (episode.outcome == EpisodeOutcome::kOpened) times.push_back(episode.simulated_s);
    summary.peak_force_n = std::max(summary.peak_force_n, episode.peak_force_n);
  }
  summary.handle_done = WilsonRate(done, all);
  summary.median_opening_s = MedianOf(times);
  summary.median_force_n = MedianOf(forces);
  for (const double angle : kSuccessAngles) {
    const auto beyond = std::count_if(episodes.begin(), episodes.end(),
                                      [&](const auto& e) { return e.peak_hinge_rad > angle; });
    summary.over_angle.push_back({angle, WilsonRate(static_cast<int>(beyond), all)});
  }
  return summary;
}

std::vector<FailureCause> CausesOf(std::span<const EvaluatedEpisode> episodes) {
  std::vector<FailureCause> causes;
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    if (episodes[i].outcome == EpisodeOutcome::kOpened) continue;
    const std::string_view name = CauseOf(episodes[i]);
    auto known = std::ranges::find(causes, name, &FailureCause::name);
    if (known == causes.end()) known = causes.insert(known, {std::string(name), 0, i});
    ++known->episodes;
  }
  std::ranges::stable_sort(causes, std::greater{}, &FailureCause::episodes);
  return causes;
}

std::vector<EvaluatedEpisode> OfCategory(std::span<const EvaluatedEpisode> episodes,
                                         Category category) {
  std::vector<EvaluatedEpisode> chosen;
  std::copy_if(episodes.begin(), episodes.end(), std::back_inserter(chosen),
               [&](const auto& e) { return e.category == category; });
  return chosen;
}

std::vector<Category> CategoriesOf(std::span<const EvaluatedEpisode> episodes) {
  std::vector<Category> categories;
  for (const EvaluatedEpisode& episode : episodes) categories.push_back(episode.category);
  std::sort(categories.begin(), categories.end());
  categories.erase(std::unique(categories.begin(), categories.end()), categories.end());
  return categories;
}

}  // namespace doorforge

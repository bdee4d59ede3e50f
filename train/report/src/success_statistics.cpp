// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/success_statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

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

template <class Succeeded>
SuccessRate RateOf(std::span<const EvaluatedEpisode> episodes, const Succeeded& succeeded) {
  std::vector<ClusteredTrial> trials;
  trials.reserve(episodes.size());
  for (const EvaluatedEpisode& episode : episodes)
    trials.push_back({episode.body, episode.handle, succeeded(episode) ? 1.0 : 0.0});
  return ClusteredRate(trials);
}

// The upper of the two in the middle of an even number; 0 of none.
double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The smallest value that a share of all do not pass; 0 of none.
double QuantileOf(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

void AddNetForce(std::span<const EvaluatedEpisode> episodes, SuccessSummary& summary) {
  std::vector<double> forces;
  for (const EvaluatedEpisode& episode : episodes) forces.push_back(episode.peak_net_force_n);
  summary.median_net_force_n = MedianOf(forces);
  summary.most_net_force_n = QuantileOf(forces, 0.99);
  summary.peak_net_force_n = QuantileOf(forces, 1);
  for (const double limit : kForceLimits) {
    const auto gently = [&](const EvaluatedEpisode& episode) {
      return episode.outcome == EpisodeOutcome::kOpened && episode.peak_net_force_n <= limit;
    };
    summary.within_force.push_back({limit, RateOf(episodes, gently)});
  }
}

}  // namespace

SuccessSummary Summarise(std::span<const EvaluatedEpisode> episodes) {
  SuccessSummary summary;
  std::vector<double> times;
  std::vector<double> forces;
  for (const EvaluatedEpisode& episode : episodes) {
    ++summary.outcomes.at(static_cast<std::size_t>(episode.outcome));
    forces.push_back(episode.peak_force_n);
    if (episode.outcome == EpisodeOutcome::kOpened) times.push_back(episode.simulated_s);
    summary.peak_force_n = std::max(summary.peak_force_n, episode.peak_force_n);
  }
  summary.opened = RateOf(
      episodes, [](const auto& episode) { return episode.outcome == EpisodeOutcome::kOpened; });
  summary.handle_turned =
      RateOf(episodes, [](const auto& episode) { return episode.handle_turned; });
  summary.over_seeds = SpreadOf(episodes);
  summary.median_opening_s = MedianOf(times);
  summary.median_force_n = MedianOf(forces);
  AddNetForce(episodes, summary);
  for (const double angle : kSuccessAngles) {
    summary.over_angle.push_back(
        {angle, RateOf(episodes, [&](const auto& e) { return e.peak_hinge_rad > angle; })});
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

std::string NameOf(const EpisodeGroup& group) {
  if (!group.category) return "overall";
  std::string name(NameOf(*group.category));
  if (group.latched) name += *group.latched ? "/latched" : "/unlatched";
  return name;
}

std::vector<EpisodeGroup> GroupsOf(std::span<const EvaluatedEpisode> episodes) {
  std::vector<EpisodeGroup> groups = {{}};
  for (const Category category : CategoriesOf(episodes)) {
    groups.push_back({category, {}});
    const std::vector<EpisodeGroup> kinds = {{category, true}, {category, false}};
    const bool has_both = std::ranges::all_of(
        kinds, [&](const EpisodeGroup& kind) { return !OfGroup(episodes, kind).empty(); });
    if (has_both) groups.insert(groups.end(), kinds.begin(), kinds.end());
  }
  return groups;
}

std::vector<EvaluatedEpisode> OfGroup(std::span<const EvaluatedEpisode> episodes,
                                      const EpisodeGroup& group) {
  std::vector<EvaluatedEpisode> chosen;
  std::ranges::copy_if(episodes, std::back_inserter(chosen), [&](const EvaluatedEpisode& episode) {
    const bool latched = episode.mechanism != Mechanism::kNone;
    return (!group.category || episode.category == *group.category) &&
           (!group.latched || latched == *group.latched);
  });
  return chosen;
}

std::vector<EvaluatedEpisode> OfCategory(std::span<const EvaluatedEpisode> episodes,
                                         Category category) {
  return OfGroup(episodes, {category, {}});
}

std::vector<Category> CategoriesOf(std::span<const EvaluatedEpisode> episodes) {
  std::vector<Category> categories;
  for (const EvaluatedEpisode& episode : episodes) categories.push_back(episode.category);
  std::sort(categories.begin(), categories.end());
  categories.erase(std::unique(categories.begin(), categories.end()), categories.end());
  return categories;
}

}  // namespace doorforge

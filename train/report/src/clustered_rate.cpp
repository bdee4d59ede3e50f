// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/report/success_statistics.h"

namespace doorforge {
namespace {

constexpr int kResamples = 1000;

/// The trials of one door: numbers of its parts, how many, and how much of them succeeded.
struct Cell {
  std::size_t body = 0;
  std::size_t handle = 0;
  double trials = 0;
  double successes = 0;
};

struct Table {
  std::vector<Cell> cells;
  std::size_t bodies = 0;
  std::size_t handles = 0;
};

Table TableOf(std::span<const ClusteredTrial> trials) {
  std::map<std::string, std::size_t> bodies;
  std::map<std::string, std::size_t> handles;
  for (const ClusteredTrial& trial : trials) bodies[trial.body] = handles[trial.handle] = 0;
  // numbered in the order of the names, whatever that of the trials
  for (auto* names : {&bodies, &handles}) {
    std::size_t number = 0;
    for (auto& [name, place] : *names) place = number++;
  }
  std::map<std::pair<std::size_t, std::size_t>, Cell> cells;
  for (const ClusteredTrial& trial : trials) {
    const std::pair place(bodies.at(trial.body), handles.at(trial.handle));
    Cell& cell = cells[place];
    cell.body = place.first;
    cell.handle = place.second;
    ++cell.trials;
    cell.successes += trial.success;
  }
  Table table{{}, bodies.size(), handles.size()};
  for (const auto& [place, cell] : cells) table.cells.push_back(cell);
  return table;
}

// How often each of `count` is drawn in as many draws.
std::vector<double> Drawn(std::size_t count, Rng& rng) {
  std::vector<double> drawn(count);
  for (std::size_t i = 0; i < count; ++i) ++drawn[rng.Index(static_cast<std::uint32_t>(count))];
  return drawn;
}

// The rates of resamples of bodies and handles, both at a time; those in which no pair had been
// tried are left out.
std::vector<double> ResampledRates(const Table& table) {
  Rng rng(0, "clustered_rate");
  std::vector<double> rates;
  for (int i = 0; i < kResamples; ++i) {
    const std::vector<double> bodies = Drawn(table.bodies, rng);
    const std::vector<double> handles = Drawn(table.handles, rng);
    double trials = 0;
    double successes = 0;
    for (const Cell& cell : table.cells) {
      const double weight = bodies[cell.body] * handles[cell.handle];
      trials += weight * cell.trials;
      successes += weight * cell.successes;
    }
    if (trials > 0) rates.push_back(successes / trials);
  }
  return rates;
}

double ResampledVariance(const Table& table) {
  double sum = 0;
  double squares = 0;
  const std::vector<double> rates = ResampledRates(table);
  for (const double rate : rates) {
    sum += rate;
    squares += rate * rate;
  }
  const auto count = static_cast<double>(rates.size());
  if (rates.empty()) return 0;
  return std::max(0.0, squares / count - (sum / count) * (sum / count));
}

}  // namespace

SuccessRate ClusteredRate(std::span<const ClusteredTrial> trials) {
  if (trials.empty()) return {};
  SuccessRate rate;
  double successes = 0;
  for (const ClusteredTrial& trial : trials) successes += trial.success;
  rate.episodes = static_cast<int>(trials.size());
  rate.successes = static_cast<int>(std::lround(successes));
  rate.rate = successes / rate.episodes;
  const Table table = TableOf(trials);
  const double variance = ResampledVariance(table);
  rate.trials = static_cast<double>(table.cells.size());
  const double of_one = rate.rate * (1 - rate.rate);
  if (variance > 0) rate.trials = std::clamp(of_one / variance, 1.0, rate.trials);
  const Interval interval = WilsonInterval(rate.rate * rate.trials, rate.trials);
  rate.low = std::min(interval.low, rate.rate);
  rate.high = std::max(interval.high, rate.rate);
  return rate;
}

ClusteredDifference MeanDifference(std::span<const ClusteredTrial> trials) {
  if (trials.empty()) return {};
  ClusteredDifference difference;
  difference.trials = static_cast<int>(trials.size());
  const Table table = TableOf(trials);
  double sum = 0;
  for (const Cell& cell : table.cells) sum += cell.successes;
  difference.mean = sum / difference.trials;
  std::vector<double> rates = ResampledRates(table);
  if (rates.empty()) rates = {difference.mean};
  std::ranges::sort(rates);
  const auto at = [&](double share) {
    return rates[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(rates.size() - 1)))];
  };
  difference.low = std::min(at(0.025), difference.mean);
  difference.high = std::max(at(0.975), difference.mean);
  return difference;
}

}  // namespace doorforge

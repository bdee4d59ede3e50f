// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/datagen/collection_plan.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

std::string KeyOf(std::uint64_t number) {
  char text[32];
  std::snprintf(text, sizeof text, "ep%06llu", static_cast<unsigned long long>(number));
  return text;
}

std::vector<std::size_t> SortedById(std::span<const DoorParts> doors) {
  std::vector<std::size_t> order(doors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return doors[a].door_id < doors[b].door_id; });
  return order;
}

// Doors in the order in which round number `round` opens them.
std::vector<std::size_t> RoundOf(std::vector<std::size_t> order, std::uint64_t round,
                                 std::uint64_t seed) {
  Rng rng(seed, "plan/round/" + std::to_string(round));
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[rng.Index(static_cast<std::uint32_t>(i))]);
  return order;
}

void AppendShards(const std::vector<PlannedEpisode>& episodes, const std::string& split,
                  std::size_t shard_size, std::vector<PlannedShard>& shards) {
  for (std::size_t first = 0; first < episodes.size(); first += shard_size) {
    const auto begin = episodes.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end =
        begin + static_cast<std::ptrdiff_t>(std::min(shard_size, episodes.size() - first));
    shards.push_back({split, static_cast<int>(first / shard_size), {begin, end}});
  }
}

}  // namespace

std::string_view SplitNameOf(DoorSide side) { return side == DoorSide::kTrain ? "train" : "val"; }

CollectionPlan MakePlan(std::span<const DoorParts> doors, std::uint64_t episodes,
                        std::uint64_t seed, const CollectionConfig& config) {
  Require(!doors.empty() && episodes >= 1, ErrorCode::kInvalidArgument,
          "collection plan: needs doors and at least one episode");
  Require(config.episodes_per_shard >= 1 && config.episodes_per_shard <= 100000,
          ErrorCode::kInvalidConfig, "config.episodes_per_shard: out of 1..100000");
  Require(config.val_fraction >= 0 && config.val_fraction <= 0.5, ErrorCode::kInvalidConfig,
          "config.val_fraction: out of 0..0.5");
  CollectionPlan plan;
  plan.sides = SplitDoors(doors, config.val_fraction, seed);
  const std::vector<std::size_t> order = SortedById(doors);
  std::vector<PlannedEpisode> training;
  std::vector<PlannedEpisode> validating;
  std::vector<std::size_t> round;
  for (std::uint64_t number = 0; number < episodes; ++number) {
    if (number % order.size() == 0) round = RoundOf(order, number / order.size(), seed);
    const std::size_t door = round[number % order.size()];
    auto& side = plan.sides[door] == DoorSide::kTrain ? training : validating;
    side.push_back({number, door, KeyOf(number)});
  }
  const auto shard_size = static_cast<std::size_t>(config.episodes_per_shard);
  AppendShards(training, "train", shard_size, plan.shards);
  AppendShards(validating, "val", shard_size, plan.shards);
  return plan;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/collection_plan.h"

#include <algorithm>
#include <cstdio>

#include "doorforge/core/error.h"

#include "balanced_draw.h"

namespace doorforge {
namespace {

std::string KeyOf(std::uint64_t number) {
  char text[32];
  std::snprintf(text, sizeof text, "ep%06llu", static_cast<unsigned long long>(number));
  return text;
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
  BalancedDraw draw(doors, seed);
  std::vector<PlannedEpisode> training;
  std::vector<PlannedEpisode> validating;
  for (std::uint64_t number = 0; number < episodes; ++number) {
    const std::size_t door = draw.Next();
    auto& side = plan.sides[door] == DoorSide::kTrain ? training : validating;
    side.push_back({number, door, KeyOf(number)});
  }
  const auto shard_size = static_cast<std::size_t>(config.episodes_per_shard);
  AppendShards(training, "train", shard_size, plan.shards);
  AppendShards(validating, "val", shard_size, plan.shards);
  return plan;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/dataset/door_split.h"

namespace doorforge {

/// How episodes are laid out in shards.
struct CollectionConfig {
  /// Planned episodes a shard, failed ones included; 1..100000. 128 episodes of the opening stage
  /// make about 100 MiB.
  int episodes_per_shard = 128;
  double val_fraction = 0.1;  ///< See SplitDoors().
  /// Doors are meant whose handles are of these, such as "round" or "lever"; empty: all doors.
  std::vector<std::string> mechanisms = {};

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("episodes_per_shard", self.episodes_per_shard);
    visit("val_fraction", self.val_fraction);
    visit("mechanisms", self.mechanisms);
  }
};

struct PlannedEpisode {
  std::uint64_t number = 0;  ///< In the plan; names the scene's random streams.
  std::size_t door = 0;      ///< Index into the plan's doors.
  std::string key = {};      ///< "ep000123"
};

struct PlannedShard {
  std::string split;  ///< "train" or "val"
  int number = 0;     ///< Within its split.
  std::vector<PlannedEpisode> episodes;
};

/// Which door is opened in which episode, and which shard the episode belongs to.
struct CollectionPlan {
  std::vector<DoorSide> sides;  ///< One a door.
  std::vector<PlannedShard> shards;
};

std::string_view SplitNameOf(DoorSide side);  ///< "train", "val"

/// Doors are drawn evenly over categories, within a category over mechanisms, within a mechanism
/// over bodies, in rounds whose order is drawn anew: the numbers of episodes differ by one at most.
/// A body meets the handle that was used least with its mechanism, so that handles differ by one as
/// well where every body meets every handle, and of these the one that it has met least. So the
/// doors of the catalogue's largest category, half of all doors, are a sixth of the episodes.
/// Neither order nor number of the doors matters otherwise. Episodes keep their numbers when more
/// are asked for. Shards hold a fixed number of planned episodes, so that their bytes depend
/// neither on threads nor on which episodes fail.
///
/// A pure function of its arguments.
///
/// @param episodes Number of episodes over both sides, >= 1.
/// @throws Error(kInvalidArgument) without doors or episodes, Error(kInvalidConfig) on a setting
/// out
///     of range.
CollectionPlan MakePlan(std::span<const DoorParts> doors, std::uint64_t episodes,
                        std::uint64_t seed, const CollectionConfig& config);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "doorforge/dataset/collect.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/shard.h"

namespace doorforge {

/// An episode as it goes into its shard: members, or the cause why there are none.
struct EncodedEpisode {
  std::vector<MemberBytes> members;
  std::uint64_t decisions = 0;
  std::optional<FailedEpisode> failure;
};

/// Runs and encodes a planned episode. Throws what EpisodeRunner says to end the collection.
EncodedEpisode RunAndEncode(const PlannedEpisode& planned, const DatasetDoor& door,
                            const EpisodeRunner& runner);

}  // namespace doorforge

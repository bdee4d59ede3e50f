// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "doorforge/report/report.h"

// What a policy and its data set say about the training.

namespace doorforge::internal {

/// Every door of which the data set has planned episodes, sorted by id. Throws Error(kMissing or
/// kFormat) as reading `provenance.json` does.
std::vector<DoorIdentity> TrainingDoors(const std::filesystem::path& data);

/// PNG by door id: previews from the shards, of at most `count` training doors, evenly chosen.
/// Empty if the shards hold none.
std::map<std::string, std::string> TrainingPreviews(const std::filesystem::path& data,
                                                    std::size_t count);

/// The policy's loss curves with names for people; none if its folder has no `losses.json`.
std::vector<LossCurve> TrainingLosses(const std::filesystem::path& policy);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"

namespace doorforge {

struct RobomimicRequest {
  std::filesystem::path folder;  ///< The dataset's.
  std::string stage = "open";    ///< One file holds one stage, all its splits.
  std::filesystem::path out;     ///< The HDF5 file.
  Existing existing = Existing::kRefuse;
  std::function<void()> on_episode;  ///< Called after each episode; may be empty.
};

struct RobomimicSummary {
  std::uint64_t demos = 0;
  std::uint64_t samples = 0;
  std::uint64_t bytes = 0;    ///< The file has so many.
  int stopped_by_signal = 0;  ///< Then there is no file.
};

/// Episodes that the file will hold, for progress. Throws Error as ReadDataset().
std::uint64_t CountEpisodes(const std::filesystem::path& folder, const std::string& stage);

/// Copies a stage's episodes into one HDF5 file as robomimic lays it out
/// (https://robomimic.github.io/docs/datasets/overview.html):
///
///     data                 attributes total, env_args (JSON), schema, config_sha256, and
///                          action_scale, action_offset: 9 numbers each
///     data/demo_N          attributes num_samples, success, and key, split, door_id, category,
///                          mechanism; N counts all splits, in the order of dataset.json
///       actions            T x 9 float32 within [-1, 1]: action.npy is
///                          action_offset + action_scale * actions
///       rewards            T float32, as score.npy
///       dones              T uint8, 1 at the last decision
///       obs/<name>         what a policy may see, as it is in the shard: cloud, proprio
///       extras/<name>      every other array, as it is in the shard, and action: what a robot
///                          does not know, and what it was told to do
///       meta               meta.json as text
///     mask/<split>         names of the split's demos
///
/// Every member is checked against its CRC. The bytes depend on the dataset alone. The file appears
/// under its name when it is complete.
///
/// @throws Error(kMissing) if the stage has no episodes, Error(kInvalidArgument) if the file exists
///     and is not to be replaced, Error(kIo) if it cannot be written or the disk has no room for it
///     (checked before anything is written), Error(kFormat) on damaged shards.
RobomimicSummary ExportRobomimic(const RobomimicRequest& request);

/// {"schema": "doorforge.dataset_export", "schema_version", ...}
nlohmann::ordered_json ExportToJson(const RobomimicRequest& request,
                                    const RobomimicSummary& summary);

/// Says what ExportToJson() says, in a line for people.
std::string ExportText(const RobomimicRequest& request, const RobomimicSummary& summary);

}  // namespace doorforge

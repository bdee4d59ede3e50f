// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "doorforge/schemas/shard.h"

namespace doorforge {

/// Letters, digits, '_' and '-'; at most 60. No dots: readers split a member's name at the first.
bool IsKey(std::string_view key);
/// Such as "cloud.npy": lower case, at least one dot, at most 39 characters.
bool IsMemberName(std::string_view name);
bool SameMembers(const ShardEpisode& a, const ShardEpisode& b);

/// The parts of an index's JSON; the readers throw Error(kFormat).
nlohmann::ordered_json ShardEpisodeToJson(const ShardEpisode& episode);
ShardEpisode ShardEpisodeFromJson(const nlohmann::ordered_json& json, const std::string& path);
nlohmann::ordered_json FailedEpisodeToJson(const FailedEpisode& failure);
FailedEpisode FailedEpisodeFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge

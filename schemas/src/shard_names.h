// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "doorforge/schemas/shard.h"

namespace doorforge {

/// Letters, digits, '_' and '-'; at most 60. No dots: readers split a member's name at the first.
bool IsKey(std::string_view key);
/// Such as "cloud.npy": lower case, at least one dot, at most 39 characters.
bool IsMemberName(std::string_view name);
bool SameMembers(const ShardEpisode& a, const ShardEpisode& b);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace doorforge {

/// What is in a dataset, from its records and indices alone (no shard is read): parts, doors by
/// category and mechanism, success rate, causes of failure, decisions an episode, sizes.
///
/// @throws Error(kMissing or kFormat).
nlohmann::ordered_json DescribeDataset(const std::filesystem::path& folder);

/// Says it for people, as a table.
std::string DescriptionText(const nlohmann::ordered_json& description);

}  // namespace doorforge

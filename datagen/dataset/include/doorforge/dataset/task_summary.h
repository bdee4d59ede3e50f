// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/dataset/collect.h"

namespace doorforge {

/// What a task of several has done: {"schema": "doorforge.collection_task", "schema_version", ...}
nlohmann::ordered_json TaskSummaryToJson(const CollectSummary& summary, const CollectionTask& task);

/// Says what TaskSummaryToJson() says, in a line for people.
///
/// @param folder The dataset's, as the user named it.
std::string TaskSummaryText(const CollectSummary& summary, const CollectionTask& task,
                            const std::filesystem::path& folder);

}  // namespace doorforge

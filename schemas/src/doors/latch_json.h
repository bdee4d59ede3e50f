// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

nlohmann::ordered_json LatchToJson(const Latch& latch);
Latch LatchFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge::internal

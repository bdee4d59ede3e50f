// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_io.h"

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge::internal {

void ThrowConfigError(const std::string& path, const std::string& problem) {
  throw Error(ErrorCode::kInvalidConfig, path + ": " + problem);
}

void ThrowUnknownKey(const std::string& path, const std::string& key,
                     const std::vector<std::string>& known) {
  ThrowConfigError(path + "." + key,
                   "unknown key; did you mean \"" + NearestName(key, known) + "\"?");
}

}  // namespace doorforge::internal

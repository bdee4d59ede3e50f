// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace doorforge {

/// The known name with the smallest Levenshtein distance to `name`, the first of equals; empty if
/// there is none. For "unknown X; did you mean Y?".
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

/// An array of numbers. JSON has no NaN: what is not finite, such as a figure that was not
/// measured, is null.
nlohmann::ordered_json NumbersToJson(const std::vector<double>& numbers);

/// The inverse, with NaN for null. Throws Error(kFormat) that names `path` for anything else.
std::vector<double> NumbersFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/json_numbers.h"

#include <cmath>
#include <limits>

#include "doorforge/core/error.h"

namespace doorforge {

using Json = nlohmann::ordered_json;

Json NumbersToJson(const std::vector<double>& numbers) {
  Json json = Json::array();
  for (const double number : numbers)
    json.push_back(std::isfinite(number) ? Json(number) : Json(nullptr));
  return json;
}

std::vector<double> NumbersFromJson(const Json& json, const std::string& path) {
  const auto refuse = [&] {
    throw Error(ErrorCode::kFormat, path + ": expected an array of numbers or null");
  };
  if (!json.is_array()) refuse();
  std::vector<double> numbers;
  for (const Json& number : json) {
    if (!number.is_number() && !number.is_null()) refuse();
    numbers.push_back(number.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                       : number.get<double>());
  }
  return numbers;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/json_numbers.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonNumbers, WhatIsNotFiniteIsNullAndComesBackAsNan) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Json json = NumbersToJson({0.1, std::nan(""), -infinity, 3});
  EXPECT_EQ(json.dump(), "[0.1,null,null,3.0]");
  const std::vector<double> numbers = NumbersFromJson(json, "here");
  ASSERT_EQ(numbers.size(), 4U);
  EXPECT_EQ(numbers[0], 0.1);
  EXPECT_TRUE(std::isnan(numbers[1]) && std::isnan(numbers[2]));
  EXPECT_EQ(numbers[3], 3);
}

TEST(JsonNumbers, RefusesWhatIsNoNumberAndNamesThePlace) {
  for (const Json& json : {Json(3), Json{"1"}, Json{{"a", 1}}, Json{1, true}}) {
    try {
      NumbersFromJson(json, "losses.json.train");
      ADD_FAILURE() << json.dump();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      EXPECT_EQ(std::string(error.what()).find("losses.json.train: expected"), 0U);
    }
  }
}

}  // namespace
}  // namespace doorforge

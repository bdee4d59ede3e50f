// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/json_file.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

std::string WhyRefused(const std::string& text) {
  try {
    ParseJson(text, "my.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with("my.json: ")) << what;
    EXPECT_EQ(what.find("exception"), std::string::npos) << what;
    return what;
  }
  return {};
}

std::string Nested(int depth) { return std::string(static_cast<std::size_t>(depth), '['); }
std::string Closed(int depth) {
  return Nested(depth) + std::string(static_cast<std::size_t>(depth), ']');
}

TEST(JsonFile, IsReadToADepthOfSixtyFour) {
  EXPECT_EQ(WhyRefused(Closed(kMaxJsonDepth)), "");
  EXPECT_NE(WhyRefused(Closed(kMaxJsonDepth + 1)).find("64 levels"), std::string::npos);
  EXPECT_NE(WhyRefused(Closed(300'000)), "");
  EXPECT_NE(WhyRefused(Nested(300'000)), "");
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += R"({"a":)";
  EXPECT_NE(WhyRefused(objects), "");
}

TEST(JsonFile, BracketsInTextsAreNotNesting) {
  EXPECT_EQ(WhyRefused("[\"" + Nested(1000) + "\", \"\\\"" + Nested(1000) + "\"]"), "");
}

TEST(JsonFile, ASyntaxErrorNamesLineAndColumn) {
  EXPECT_EQ(WhyRefused("{\n  \"a\": }"), "my.json: not JSON: line 2, column 8");
  EXPECT_NE(WhyRefused("[1e999]"), "");
  EXPECT_NE(WhyRefused("[\"\xff\"]"), "");
  EXPECT_NE(WhyRefused(""), "");
}

// The library stops there and takes what came before for the whole.
TEST(JsonFile, AZeroByteIsNotTheEnd) {
  const std::string zero(1, '\0');
  EXPECT_EQ(WhyRefused("{}" + zero), "my.json: not JSON: line 1, column 3");
  EXPECT_NE(WhyRefused("{}\n" + zero + "and more"), "");
  EXPECT_NE(WhyRefused(zero + "{}"), "");
}

TEST(JsonFile, TextThatIsNoUtf8IsWrittenAsJson) {
  const Json json = {{"name",
                      "a\xff"
                      "b"},
                     {"good", "t\xc3\xbcr"}};
  const std::string text = JsonText(json);
  EXPECT_EQ(text,
            "{\"name\":\"a\xef\xbf\xbd"
            "b\",\"good\":\"t\xc3\xbcr\"}");
  EXPECT_EQ(ParseJson(text, "again").at("good"), "t\xc3\xbcr");
  EXPECT_EQ(JsonText({{"a", {1, 2.5}}}, 2), Json({{"a", {1, 2.5}}}).dump(2));
}

TEST(JsonFile, AnIntegerThatDoesNotFitIsRefused) {
  const Json json = ParseJson(R"({"big": 4294967297, "minus": -1, "fine": 7})", "r");
  EXPECT_EQ(ValueOf<int>(json, "fine", "r"), 7);
  EXPECT_THROW(ValueOf<int>(json, "big", "r"), Error);
  EXPECT_THROW(ValueOf<std::uint64_t>(json, "minus", "r"), Error);
  EXPECT_EQ(ValueOf<std::uint64_t>(json, "big", "r"), 4294967297U);
  EXPECT_EQ(ValueOf<int>(json, "minus", "r"), -1);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_difference.h"

#include <gtest/gtest.h>

namespace doorforge {
namespace {

TEST(ConfigDifference, NamesTheSettingsThatDifferAndNoOthers) {
  EXPECT_EQ(ConfigDifference(R"({"epochs": 4, "seed": 1, "device": "cpu"})",
                             R"({"epochs": 6, "seed": 1, "device": "cuda"})"),
            "\n  epochs: recorded 4, given 6\n  device: recorded \"cpu\", given \"cuda\"");
}

TEST(ConfigDifference, NamesSettingsByTheirPathAndThoseThatOneOfBothLacks) {
  EXPECT_EQ(ConfigDifference("a: {b: {c: 1, d: 2}, e: 3}", "a: {b: {c: 1, d: 5}}\nf: [1, 2]"),
            "\n  a.b.d: recorded 2, given 5\n  a.e: recorded 3, given none\n  f: recorded none, "
            "given [1,2]");
}

TEST(ConfigDifference, NamesCommentsSinceTheySayWhatElseDecides) {
  EXPECT_EQ(ConfigDifference("# open, 1.0\n# 3 doors\n{\"seed\": 1}\n",
                             "# open, 1.0\n# 4 doors\n# a policy\n{\"seed\": 1}\n"),
            "\n  recorded: # 3 doors\n  given:    # 4 doors\n  recorded: none\n  given:    # a "
            "policy");
}

TEST(ConfigDifference, IsEmptyWhereBothSayTheSame) {
  EXPECT_EQ(ConfigDifference("{\"a\": 1, \"b\": 2}", "b: 2\na: 1.0"), "");
}

TEST(ConfigDifference, ComparesLinesOfWhatIsNoConfig) {
  EXPECT_EQ(ConfigDifference("{\"a\": 1,", "{\"a\": 1}"),
            "\n  recorded: {\"a\": 1,\n  given:    {\"a\": 1}");
}

TEST(ConfigDifference, StaysShort) {
  std::string many;
  for (int i = 0; i < 30; ++i)
    many += "key" + std::to_string(i) + ": " + std::string(500, 'x') + "\n";
  const std::string text = ConfigDifference(many, "other: 1");
  EXPECT_LT(text.size(), 6000U);
  EXPECT_NE(text.find("and 11 lines more"), std::string::npos) << text;
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/split.h"

#include <fstream>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

std::filesystem::path Written(const std::string& text) {
  const std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("split_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".yaml");
  std::ofstream(path) << text;
  return path;
}

ErrorCode CodeOf(const std::string& text) {
  try {
    ReadSplit(Written(text));
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "was accepted: " << text;
  return ErrorCode::kMissing;
}

constexpr const char* kHead = "schema: doorforge.split\nschema_version: 2\n";

TEST(Split, ListsItsPartsSideBySide) {
  const Split split =
      ReadSplit(Written(std::string(kHead) + "train: [b, a]\nvalidation: [d]\ntest: [c]\n"));
  EXPECT_EQ(split.train, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(split.validation, std::vector<std::string>{"d"});
  EXPECT_EQ(split.test, std::vector<std::string>{"c"});
  EXPECT_TRUE(split.unseen_categories.empty());
  EXPECT_EQ(PartsOf(split), (std::vector<std::string>{"a", "b", "c", "d"}));
  EXPECT_EQ(SidesOf(split).at("validation"), &split.validation);
}

TEST(Split, RefusesAPartOnTwoSides) {
  EXPECT_EQ(CodeOf(std::string(kHead) + "train: [a]\ntest: [a]\n"), ErrorCode::kInvalidConfig);
  EXPECT_EQ(CodeOf(std::string(kHead) + "validation: [a]\ntest: [a]\n"), ErrorCode::kInvalidConfig);
}

TEST(Split, RefusesAnotherSchemaAndALaterVersion) {
  EXPECT_EQ(CodeOf("schema: doorforge.recipe\nschema_version: 1\n"), ErrorCode::kFormat);
  EXPECT_EQ(CodeOf("schema: doorforge.split\nschema_version: 3\n"), ErrorCode::kFormat);
  EXPECT_EQ(CodeOf("train: [a]\n"), ErrorCode::kFormat);
}

TEST(Split, RefusesAnUnknownKey) {
  EXPECT_EQ(CodeOf(std::string(kHead) + "tset: [a]\n"), ErrorCode::kInvalidConfig);
}

}  // namespace
}  // namespace doorforge

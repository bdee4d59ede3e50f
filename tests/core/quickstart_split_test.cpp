// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/pipeline/quickstart_split.h"

#include <set>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/shape_descriptor.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class QuickstartSplit : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("quickstart_split_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void AddPart(const std::string& id, const std::string& role, const std::string& mechanism,
               const std::string& source, const ShapeDescriptor& shape = {}) {
    WriteJsonFile(folder_ / id / "part.json", {{"id", id},
                                               {"role", role},
                                               {"category", "interior"},
                                               {"mechanism", mechanism},
                                               {"source_sha256", source},
                                               {"shape", shape}});
  }

  void AddParts(int bodies, int levers) {
    for (int i = 0; i < bodies; ++i) {
      const std::string id = "body" + std::to_string(i);
      AddPart(id, "body", "none", id);
    }
    for (int i = 0; i < levers; ++i) {
      const std::string id = "lever" + std::to_string(i);
      AddPart(id, "handle", "lever", id);
    }
  }

  fs::path folder_;
};

TEST_F(QuickstartSplit, NoBodyAndNoHandleIsOnBothSides) {
  AddParts(9, 9);
  std::set<std::string> train;
  std::set<std::string> test;
  for (const DoorPair& pair : SplitIntoDoors(folder_, 7)) {
    std::set<std::string>& side = pair.subset == "train" ? train : test;
    side.insert(pair.body_id);
    side.insert(pair.handle_id);
  }
  EXPECT_FALSE(test.empty());
  for (const std::string& id : test) EXPECT_FALSE(train.contains(id)) << id;
}

TEST_F(QuickstartSplit, PartsOfOneSourceStayTogether) {
  AddParts(6, 6);
  AddPart("body2-scaled", "body", "none", "body2");  // body2 is the third, so held out
  for (const DoorPair& pair : SplitIntoDoors(folder_, 7)) {
    if (!pair.body_id.starts_with("body2")) continue;
    EXPECT_EQ(pair.subset, "test");
  }
}

TEST_F(QuickstartSplit, CopiesAtAnotherSizeStayTogether) {
  AddParts(6, 6);
  AddPart("body2", "body", "none", "body2", ShapeDescriptor(13, 0.2));
  AddPart("body2 from elsewhere", "body", "none", "another hash", ShapeDescriptor(13, 0.2001));
  for (const DoorPair& pair : SplitIntoDoors(folder_, 7)) {
    if (!pair.body_id.starts_with("body2")) continue;
    EXPECT_EQ(pair.subset, "test");
  }
}

TEST_F(QuickstartSplit, IsAFunctionOfTheSeed) {
  AddParts(12, 12);
  const auto names = [&](std::uint64_t seed) {
    std::vector<std::string> all;
    for (const DoorPair& pair : SplitIntoDoors(folder_, seed))
      all.push_back(pair.subset + pair.body_id + pair.handle_id);
    return all;
  };
  EXPECT_EQ(names(7), names(7));
  EXPECT_NE(names(7), names(8));
}

TEST_F(QuickstartSplit, TooFewPartsAreRefused) {
  AddParts(2, 2);
  EXPECT_THROW(SplitIntoDoors(folder_, 7), Error);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/describe_dataset.h"

#include "doorforge/core/error.h"

#include "synthetic.h"

namespace doorforge {
namespace {

class DescribeDatasetTest : public synthetic::CollectionTest {};

TEST_F(DescribeDatasetTest, CountsEpisodesDoorsAndCauses) {
  const CollectSummary summary = CollectInto(folder_);
  const nlohmann::ordered_json description = DescribeDataset(folder_);
  std::uint64_t episodes = 0;
  std::uint64_t bytes = 0;
  for (const auto& part : description.at("parts")) {
    episodes += part.at("episodes").get<std::uint64_t>();
    bytes += part.at("bytes").get<std::uint64_t>();
    EXPECT_EQ(part.at("decisions_per_episode"), 4.0);
  }
  EXPECT_EQ(episodes, summary.written);
  EXPECT_EQ(bytes, summary.bytes);
  EXPECT_EQ(description.at("failures").at("grip_lost"), 6);
  EXPECT_EQ(description.at("doors").size(), 2U);
  EXPECT_EQ(description.at("doors")[0].at("doors"), 5);

  const std::string text = DescriptionText(description);
  EXPECT_NE(text.find("grip_lost                6\n"), std::string::npos) << text;
  EXPECT_NE(text.find("interior          lever          5"), std::string::npos) << text;
}

TEST_F(DescribeDatasetTest, SaysThatAFolderHoldsNoDataset) {
  EXPECT_THROW(DescribeDataset(folder_), Error);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "doorforge/core/committed_file.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/describe_episodes.h"
#include "doorforge/dataset/verify_dataset.h"

#include "synthetic.h"

// tests/golden/dataset_v1 was written by the first builds of format version 1 and never changes:
// eight episodes of seven doors, one failure. tests/dataset/reader_test.py reads it in Python.

namespace doorforge {
namespace {

const std::filesystem::path kGolden = DOORFORGE_SOURCE_DIR "/tests/golden/dataset_v1";

// As the list beside the folder has them.
std::map<std::string, std::string> ListedHashes(const std::filesystem::path& folder) {
  std::istringstream lines(ReadFile(folder.string() + ".sha256"));
  std::map<std::string, std::string> listed;
  std::string hash;
  std::string path;
  while (lines >> hash >> path) listed[path] = hash;
  return listed;
}

TEST(GoldenDatasetTest, TheFilesAreTheOnesThatWereCommitted) {
  EXPECT_EQ(synthetic::HashesBelow(kGolden), ListedHashes(kGolden));
}

// Written by the first builds that kept failed grasps, joint states and a checksum of the index.
const std::filesystem::path kGoldenGrasps = DOORFORGE_SOURCE_DIR "/tests/golden/dataset_v1_grasp";

TEST(GoldenDatasetTest, GraspsThatFailedAreReadAndCountedAsFailed) {
  EXPECT_EQ(synthetic::HashesBelow(kGoldenGrasps), ListedHashes(kGoldenGrasps));
  const DatasetReader reader(kGoldenGrasps, "grasp", "train");
  ASSERT_EQ(reader.size(), 4U);
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    EXPECT_EQ(arrays.decisions, 1U);
    EXPECT_EQ(arrays.state.size(), 14U);
    EXPECT_EQ(reader.Meta(i).at("success"), arrays.score[0] > 0.7F);
  }
  for (const DatasetFinding& finding : VerifyDataset({kGoldenGrasps, 1, {}}))
    ADD_FAILURE() << finding.code << ' ' << finding.where << ": " << finding.measured;
  const EpisodeDescription description = DescribeEpisodes(kGoldenGrasps, 0);
  EXPECT_EQ(description.stages.at(0).all.episodes, 5U);
  EXPECT_EQ(description.stages.at(0).all.succeeded, 2U);
  EXPECT_EQ(DescribeDataset(kGoldenGrasps).at("parts").at(0).at("success_rate").get<double>(),
            2.0 / static_cast<double>(description.stages.at(0).all.episodes));
}

// Written by the first builds that kept what was executed beside what was asked for, and in which
// hands took hold at sampled grasps as well.
const std::filesystem::path kGoldenHandles = DOORFORGE_SOURCE_DIR "/tests/golden/dataset_v1_handle";

TEST(GoldenDatasetTest, TurnsFromSampledGraspsAreReadWithWhatWasExecuted) {
  EXPECT_EQ(synthetic::HashesBelow(kGoldenHandles), ListedHashes(kGoldenHandles));
  const DatasetReader reader(kGoldenHandles, "handle", "train");
  ASSERT_EQ(reader.size(), 7U);
  std::map<std::string, int> grasps;
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    ASSERT_EQ(arrays.executed.size(), 9 * arrays.decisions);
    double largest = 0;
    for (std::size_t k = 0; k < arrays.action.size(); ++k)
      largest = std::max(largest, std::abs(double{arrays.executed[k]} - arrays.action[k]));
    EXPECT_GT(largest, 1e-3);  // the action noise
    EXPECT_LT(largest, 0.2);
    ++grasps[reader.Meta(i).at("policies").at("grasp").get<std::string>()];
  }
  EXPECT_EQ(grasps, (std::map<std::string, int>{{"expert", 5}, {"sampled", 2}}));
  for (const DatasetFinding& finding : VerifyDataset({kGoldenHandles, 1, {}}))
    ADD_FAILURE() << finding.code << ' ' << finding.where << ": " << finding.measured;
  const EpisodeDescription description = DescribeEpisodes(kGoldenHandles, 0);
  EXPECT_EQ(description.stages.at(0).all.episodes, 10U);
  EXPECT_EQ(description.stages.at(0).all.succeeded, 7U);
}

TEST(GoldenDatasetTest, IsReadByThisVersion) {
  const DatasetReader train(kGolden, "open", "train");
  const DatasetReader val(kGolden, "open", "val");
  ASSERT_EQ(train.size(), 6U);
  ASSERT_EQ(val.size(), 2U);
  std::size_t decisions = 0;
  for (std::size_t i = 0; i < train.size(); ++i) {
    const EpisodeArrays arrays = train.Arrays(i);
    EXPECT_EQ(arrays.points, 24U);
    decisions += arrays.decisions;
    EXPECT_EQ(train.Meta(i).at("outcome"), "opened");
  }
  EXPECT_EQ(decisions, 80U);
  EXPECT_EQ(train.entry(0).key, "ep000000");
}

TEST(GoldenDatasetTest, HasNoFindings) {
  for (const DatasetFinding& finding : VerifyDataset({kGolden, 1, {}}))
    ADD_FAILURE() << finding.code << ' ' << finding.where << ": " << finding.measured;
}

TEST(GoldenDatasetTest, ItsRecordsSayWhatItsShardsHold) {
  const DatasetRecord record = ReadDataset(kGolden);
  const DatasetRecord shards = SummarizeShards(kGolden);
  ASSERT_EQ(record.parts.size(), shards.parts.size());
  for (std::size_t i = 0; i < record.parts.size(); ++i)
    EXPECT_EQ(record.parts[i].decisions, shards.parts[i].decisions);
  EXPECT_EQ(record.cloud_radius_m, shards.cloud_radius_m);
  EXPECT_EQ(record.statistics.at("proprio").mean, shards.statistics.at("proprio").mean);
  EXPECT_EQ(DescribeDataset(kGolden).at("failures").at("door_stuck"), 1);
}

TEST(GoldenDatasetTest, EpisodesAreCountedByCategoryMechanismAndAngle) {
  const EpisodeDescription description = DescribeEpisodes(kGolden, 2, 2);
  ASSERT_EQ(description.stages.size(), 1U);
  const StageEpisodes& stage = description.stages[0];
  EXPECT_EQ(stage.all.episodes, 9U);
  EXPECT_EQ(stage.all.succeeded, 8U);
  EXPECT_EQ(stage.by_category.at("car").causes,
            (std::map<std::string, std::uint64_t>{{"door_stuck", 1}}));
  EXPECT_EQ(stage.by_category.at("car").hinge.counts[8], 1U);  // stuck at 44.1 degrees
  std::uint64_t histogram = 0;
  for (const std::uint64_t count : stage.all.hinge.counts) histogram += count;
  EXPECT_EQ(histogram, 9U);
  std::uint64_t opened_far = 0;
  for (std::size_t bin = 9; bin < stage.all.hinge.counts.size(); ++bin)
    opened_far += stage.all.hinge.counts[bin];
  EXPECT_EQ(opened_far, 8U);
  EXPECT_TRUE(description.examples.empty());  // it was collected without previews
}

TEST(AngleHistogramTest, TheEndsTakeWhatIsBeyond) {
  AngleHistogram histogram;
  for (const double angle : {-1.0, 0.0, 0.0872, 0.0873, 2.0943, 9.0}) histogram.Add(angle);
  EXPECT_EQ(histogram.counts[0], 3U);
  EXPECT_EQ(histogram.counts[1], 1U);
  EXPECT_EQ(histogram.counts[23], 1U);
  EXPECT_EQ(histogram.counts[24], 1U);
}

}  // namespace
}  // namespace doorforge

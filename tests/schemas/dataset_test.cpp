// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/dataset.h"

#include <cmath>

#include "doorforge/core/error.h"

#include "shard_fixture.h"

namespace doorforge {
namespace {

using fixture::MakeEpisode;
using fixture::MembersOf;

class DatasetFolder : public fixture::FolderTest {
 protected:
  // `count` episodes from number `first` on as one shard.
  void WriteShard(const std::string& split, int number, std::uint64_t first, int count) {
    ShardWriter writer(folder_ / "open" / split, {number, "open", split, "c"});
    for (int i = 0; i < count; ++i) {
      const Episode episode = MakeEpisode(first + static_cast<std::uint64_t>(i));
      writer.Add("ep" + std::to_string(first) + "_" + std::to_string(i), 3, MembersOf(episode));
    }
    writer.AddFailure({"f", "door", "door_stuck", "", 0, 0});
    writer.Commit();
  }
};

TEST_F(DatasetFolder, IsReadShardAfterShard) {
  WriteShard("train", 1, 20, 3);
  WriteShard("train", 0, 10, 2);
  const DatasetReader reader(folder_, "open", "train");
  ASSERT_EQ(reader.size(), 5U);
  EXPECT_EQ(reader.entry(0).key, "ep10_0");
  EXPECT_EQ(reader.entry(4).key, "ep20_2");
  EXPECT_EQ(reader.Meta(4).at("scene").at("episode"), 22);
  EXPECT_EQ(reader.Arrays(2).cloud[5], MakeEpisode(20).decisions[0].cloud.xyz[5]);
  EXPECT_THROW(DatasetReader(folder_, "open", "val"), Error);
  EXPECT_EQ(reader.ContentHash().size(), 64U);
}

TEST_F(DatasetFolder, IsSummarizedBySplitWithTheStatisticsOfTraining) {
  WriteShard("train", 0, 0, 4);
  WriteShard("val", 0, 50, 2);
  const DatasetRecord record = SummarizeShards(folder_);
  ASSERT_EQ(record.parts.size(), 2U);
  EXPECT_EQ(record.parts[0].split, "train");
  EXPECT_EQ(record.parts[0].episodes, 4U);
  EXPECT_EQ(record.parts[0].decisions, 12U);
  EXPECT_EQ(record.parts[0].failed_episodes, 1U);
  EXPECT_EQ(record.parts[1].episodes, 2U);

  double sum = 0;
  double square = 0;
  double radius = 0;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Episode episode = MakeEpisode(i);  // must outlive the loop over its decisions
    for (const Decision& decision : episode.decisions) {
      sum += decision.action[2];
      square += decision.action[2] * static_cast<double>(decision.action[2]);
      Eigen::Vector3d center = Eigen::Vector3d::Zero();
      const auto point = [&](std::size_t k) {
        return Eigen::Vector3d(decision.cloud.xyz[3 * k], decision.cloud.xyz[3 * k + 1],
                               decision.cloud.xyz[3 * k + 2]);
      };
      for (std::size_t k = 0; k < 40; ++k) center += point(k) / 40;
      for (std::size_t k = 0; k < 40; ++k) radius = std::max(radius, (point(k) - center).norm());
    }
  }
  const FeatureStatistics& action = record.statistics.at("action");
  EXPECT_NEAR(action.mean.at(2), sum / 12, 1e-12);
  EXPECT_NEAR(action.standard_deviation.at(2), std::sqrt(square / 12 - sum / 12 * (sum / 12)),
              1e-12);
  EXPECT_NEAR(record.cloud_radius_m, radius, 1e-9);
  EXPECT_EQ(record.statistics.at("score").minimum.at(0), 0.1F);
}

TEST_F(DatasetFolder, SurvivesARoundTripOfItsRecord) {
  WriteShard("train", 0, 0, 2);
  const nlohmann::ordered_json json = DatasetToJson(SummarizeShards(folder_));
  EXPECT_EQ(DatasetToJson(DatasetFromJson(json, "dataset")), json);
  EXPECT_EQ(json.at("features").size(), EpisodeFeatures().size());
}

TEST_F(DatasetFolder, WithoutARecordIsCalledUnfinished) {
  try {
    ReadDataset(folder_);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMissing);
    EXPECT_NE(std::string(error.what()).find("--resume"), std::string::npos);
  }
}

DatasetDoor TrainingDoor() {
  return {
      "d",       "1",    "interior", "lever", {"b", "2", ShapeDescriptor(13, 0.25)}, {"h", "3", {}},
      "CC0-1.0", "train"};
}

TEST(DatasetProvenance, SurvivesARoundTrip) {
  DatasetProvenance provenance;
  provenance.code_version = "0.1.0+abc";
  provenance.compiler = "GCC 12";
  provenance.libraries = {{"Embree", "3.13.5"}, {"Bullet", "3.24"}};
  provenance.config_sha256 = "00";
  provenance.seed = 18446744073709551615U;
  provenance.doors = {TrainingDoor()};
  const nlohmann::ordered_json json = ProvenanceToJson(provenance);
  EXPECT_EQ(ProvenanceToJson(ProvenanceFromJson(json, "provenance")), json);
}

TEST(DatasetCard, NamesTheLicenceAndTheCounts) {
  DatasetProvenance provenance;
  provenance.doors = {TrainingDoor()};
  DatasetRecord record;
  record.parts = {{"open", "train", 1, 12, 3, 150, 9 << 20}};
  const std::string card = DatasetCard(record, provenance);
  EXPECT_TRUE(card.starts_with("---\nlicense: cc0-1.0\n"));
  EXPECT_NE(card.find("| open | train | 12 | 3 | 150 | 1 | 9 |"), std::string::npos);
  provenance.doors.push_back(provenance.doors[0]);
  provenance.doors[1].license = "NOASSERTION";
  EXPECT_TRUE(DatasetCard(record, provenance).starts_with("---\nlicense: other\n"));
}

TEST(FailureLine, IsOneLineOfJson) {
  const std::string line =
      FailureLine({"ep7", "door", "grip_lost", "two\nlines", 0.1, 0.2}, {"open", "val"});
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(line).at("outcome"), "grip_lost");
}

}  // namespace
}  // namespace doorforge

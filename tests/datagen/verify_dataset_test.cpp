// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/datagen/verify_dataset.h"

#include <algorithm>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "synthetic.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class VerifyDatasetTest : public synthetic::CollectionTest {
 protected:
  void SetUp() override {
    CollectionTest::SetUp();
    CollectInto(folder_);
  }

  std::vector<DatasetFinding> Findings() const { return VerifyDataset({folder_, 2, {}}); }

  std::set<std::string> Codes() const {
    std::set<std::string> codes;
    for (const DatasetFinding& finding : Findings()) codes.insert(finding.code);
    return codes;
  }

  fs::path tar() const { return folder_ / "open/train/shard-000001.tar"; }
  fs::path index() const { return folder_ / "open/train/shard-000001.index.json"; }

  // Writes an episode with the given change as a shard of its own.
  void AddShard(const std::function<void(Episode&)>& change) const {
    CollectedEpisode collected = synthetic::RunSynthetic({0, 0, "ep900000"}, synthetic::Doors(1));
    change(collected.episode);
    ShardWriter writer(folder_ / "open/train", {99, "open", "train", "c"});
    writer.Add("ep900000", 4,
               EncodeEpisode(collected.episode, EpisodeMetaToJson(collected.episode), ""));
    writer.Commit();
  }
};

TEST_F(VerifyDatasetTest, FindsNothingInASoundDataset) {
  int shards = 0;
  EXPECT_TRUE(VerifyDataset({folder_, 1, [&] { ++shards; }}).empty());
  EXPECT_EQ(shards, static_cast<int>(plan_.shards.size()));
}

TEST_F(VerifyDatasetTest, FindsAFlippedBitAndNamesItsMember) {
  const ShardMember member = ReadShardIndex(index()).episodes.at(1).members.at(1);
  std::fstream file(tar(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(member.offset + 200));
  file.put('\x7f');
  file.close();
  const std::vector<DatasetFinding> findings = Findings();
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings[0].code, "DST003");
  EXPECT_EQ(findings[0].where, tar().string());
  EXPECT_NE(findings[0].measured.find(".cloud.npy: bytes"), std::string::npos)
      << findings[0].measured;
}

TEST_F(VerifyDatasetTest, SaysHowMuchOfACutShardIsLeft) {
  fs::resize_file(tar(), fs::file_size(tar()) / 2);
  const std::vector<DatasetFinding> findings = Findings();
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings[0].code, "DST002");
  EXPECT_NE(findings[0].measured.find("episodes are still complete"), std::string::npos)
      << findings[0].measured;
}

TEST_F(VerifyDatasetTest, FindsATarWithoutIndex) {
  fs::remove(index());
  const std::set<std::string> codes = Codes();
  EXPECT_EQ(codes.count("DST004"), 1U);
  EXPECT_EQ(codes.count("DST008"), 1U);  // and the counts no longer agree
  EXPECT_EQ(codes.count("DST010"), 1U);  // nor does the plan
}

TEST_F(VerifyDatasetTest, FindsAnIndexThatIsNotJson) {
  std::ofstream(index()) << "{";
  EXPECT_EQ(Codes().count("DST002"), 1U);
}

TEST_F(VerifyDatasetTest, FindsValuesThatCannotBe) {
  AddShard([](Episode& episode) { episode.decisions[2].action[4] = 0.5F; });
  EXPECT_EQ(Codes(), (std::set<std::string>{"DST006", "DST008"}));
}

TEST_F(VerifyDatasetTest, FindsAnExecutedTurnThatIsNone) {
  AddShard([](Episode& episode) { episode.decisions[2].executed[4] = 0.5F; });
  EXPECT_EQ(Codes(), (std::set<std::string>{"DST006", "DST008"}));
}

TEST_F(VerifyDatasetTest, FindsAFailureAmongTheSuccesses) {
  AddShard([](Episode& episode) { episode.outcome = EpisodeOutcome::kDoorStuck; });
  EXPECT_EQ(Codes(), (std::set<std::string>{"DST007", "DST008"}));
}

TEST_F(VerifyDatasetTest, FindsLabelsAndQuaternionsOutOfRange) {
  AddShard([](Episode& episode) {
    episode.decisions[0].cloud.label[3] = 9;
    episode.decisions[1].proprioception[30] = 2;
  });
  const std::vector<DatasetFinding> findings = Findings();
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                          [](const DatasetFinding& f) { return f.code == "DST006"; }),
            2);
}

TEST_F(VerifyDatasetTest, FindsAPartOnBothSides) {
  const fs::path path = folder_ / "provenance.json";
  auto json = ReadJsonFile(path);
  DatasetProvenance provenance = ProvenanceFromJson(json, "p");
  for (DatasetDoor& door : provenance.doors) door.body.sha256 = "the same";
  WriteJsonFile(path, ProvenanceToJson(provenance));
  EXPECT_EQ(Codes(), std::set<std::string>{"DST009"});
}

TEST_F(VerifyDatasetTest, FindsMissingRecords) {
  fs::remove(folder_ / "README.md");
  EXPECT_EQ(Codes(), std::set<std::string>{"DST001"});
  fs::remove(folder_ / "dataset.json");
  EXPECT_EQ(Codes(), std::set<std::string>{"DST001"});
}

TEST_F(VerifyDatasetTest, RefusesAFolderThatIsNotThere) {
  EXPECT_THROW(VerifyDataset({folder_ / "nowhere", 1, {}}), Error);
}

TEST_F(VerifyDatasetTest, CountsItsFindings) {
  fs::remove(folder_ / "README.md");
  fs::remove(folder_ / "config.yaml");
  const nlohmann::ordered_json json = FindingsToJson(Findings());
  EXPECT_EQ(json.at("findings").size(), 2U);
  EXPECT_EQ(json.at("counts").at("DST001"), 2);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/verify_dataset.h"

#include <algorithm>
#include <functional>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/dataset/dataset_card.h"
#include "doorforge/dataset/merge_dataset.h"

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
  // and it is no longer the one that was written
  EXPECT_EQ(Codes(), (std::set<std::string>{"DST009", "DST012"}));
}

TEST_F(VerifyDatasetTest, FindsMissingRecords) {
  fs::remove(folder_ / "README.md");
  EXPECT_EQ(Codes(), std::set<std::string>{"DST001"});
  fs::remove(folder_ / "dataset.json");
  EXPECT_EQ(Codes(), std::set<std::string>{"DST001"});
}

// Every file of a dataset is damaged in every way below, and verify names it each time. The list of
// files is the folder's, so that a new kind of file is damaged here as well.
class DamagedDatasetTest : public VerifyDatasetTest {
 protected:
  void SetUp() override {
    VerifyDatasetTest::SetUp();
    WriteDatasetCard(folder_);
  }

  struct Damage {
    std::string name;
    std::string content;
  };

  static std::vector<Damage> DamagesOf(const std::string& sound) {
    std::vector<Damage> damages = {{"one byte more", sound + "\n"}, {"nonsense", "garbage\n"}};
    if (sound.empty()) return damages;
    damages.push_back({"emptied", ""});
    damages.push_back({"half", sound.substr(0, sound.size() / 2)});
    damages.push_back({"last byte gone", sound.substr(0, sound.size() - 1)});
    for (const std::size_t part : {0, 1, 2, 3, 4, 5, 6, 7, 8}) {
      const std::size_t at = std::min(part * sound.size() / 8, sound.size() - 1);
      std::string flipped = sound;
      flipped[at] = static_cast<char>(flipped[at] ^ 1);
      damages.push_back({"bit 0 of byte " + std::to_string(at), flipped});
    }
    return damages;
  }

  std::vector<fs::path> Files() const {
    std::set<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) files.insert(entry.path());
    }
    return {files.begin(), files.end()};
  }

  bool Names(const fs::path& file) const {
    const std::vector<DatasetFinding> findings = Findings();
    return std::any_of(findings.begin(), findings.end(), [&](const DatasetFinding& finding) {
      return finding.severity == DatasetSeverity::kError &&
             (finding.where + ": " + finding.measured).find(file.string()) != std::string::npos;
    });
  }

  static void Write(const fs::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
  }

  // Digits of the number behind a key of a JSON text, made another number of as many.
  static std::string WithOtherDigit(std::string text, const std::string& key) {
    const std::size_t at = text.find_first_of("123456789", text.find('"' + key + '"') + key.size());
    text.at(at) = text.at(at) == '9' ? '8' : static_cast<char>(text.at(at) + 1);
    return text;
  }
};

TEST_F(DamagedDatasetTest, EveryFileIsCoveredWhereverItIsDamaged) {
  const std::vector<fs::path> files = Files();
  ASSERT_EQ(files.size(), 9 + 2 * plan_.shards.size());
  ASSERT_TRUE(Findings().empty());
  for (const fs::path& file : files) {
    const std::string sound = ReadFile(file);
    for (const Damage& damage : DamagesOf(sound)) {
      Write(file, damage.content);
      EXPECT_TRUE(Names(file)) << file << ": " << damage.name;
    }
    fs::remove(file);
    EXPECT_TRUE(AnyFault(Findings()) || file.filename() == "SHA256SUMS") << file << " removed";
    Write(file, sound);
  }
  EXPECT_TRUE(Findings().empty());
}

// What the review did by hand.
TEST_F(DamagedDatasetTest, ChangesThatKeepARecordReadableAreFound) {
  const auto expect_found = [&](const std::string& record,
                                const std::function<std::string(std::string)>& change) {
    const std::string sound = ReadFile(folder_ / record);
    Write(folder_ / record, change(sound));
    EXPECT_TRUE(Names(folder_ / record)) << record;
    Write(folder_ / record, sound);
  };
  for (const bool with_sums : {true, false}) {  // as datasets of earlier builds are
    if (!with_sums) fs::remove(folder_ / "SHA256SUMS");
    ASSERT_FALSE(AnyFault(Findings()));
    expect_found("config.yaml",
                 [](const std::string& text) { return WithOtherDigit(text, "seed"); });
    expect_found("dataset.json",
                 [](const std::string& text) { return WithOtherDigit(text, "mean"); });
    expect_found("dataset.json",
                 [](const std::string& text) { return WithOtherDigit(text, "bytes"); });
    expect_found("dataset.json",
                 [](const std::string& text) { return WithOtherDigit(text, "decisions"); });
    if (with_sums)
      expect_found("provenance.json",
                   [](const std::string& text) { return WithOtherDigit(text, "seed"); });
    expect_found("splits/train.txt",
                 [](const std::string& text) { return text.substr(text.find('\n') + 1); });
    expect_found("splits/val.txt",
                 [&](const std::string&) { return ReadFile(folder_ / "splits/train.txt"); });
    expect_found("failures.jsonl", [](const std::string&) { return std::string("garbage"); });
  }
}

// Earlier builds wrote indices without a checksum of their own, but no SHA256SUMS either.
TEST_F(DamagedDatasetTest, AnIndexThatHasLostItsChecksumIsFound) {
  nlohmann::ordered_json json = ReadJsonFile(index());
  json.erase("index_crc32c");
  Write(index(), json.dump(2) + "\n");
  EXPECT_TRUE(Names(index()));
  fs::remove(folder_ / "SHA256SUMS");
  EXPECT_FALSE(Names(index()));
}

TEST_F(DamagedDatasetTest, AnUnfinishedDatasetIsVerifiedAsFarAsItIsThere) {
  fs::remove_all(folder_);
  CollectRequest request = RequestFor(folder_, 1);
  request.task = {0, 2};
  Collect(
      plan_,
      [this](const PlannedEpisode& planned) { return synthetic::RunSynthetic(planned, doors_); },
      request);
  const std::vector<DatasetFinding> findings = Findings();
  EXPECT_EQ(Codes(), (std::set<std::string>{"DST001", "DST010"}));
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                          [](const DatasetFinding& f) { return f.code == "DST001"; }),
            1);
  for (const fs::path& file : Files()) {
    const std::string sound = ReadFile(file);
    for (const Damage& damage : DamagesOf(sound)) {
      Write(file, damage.content);
      EXPECT_TRUE(Names(file)) << file << ": " << damage.name;
    }
    Write(file, sound);
  }
}

TEST_F(DamagedDatasetTest, AFileOfTheUsersIsNamedAndNoFault) {
  Write(folder_ / "NOTES.md", "mine");
  Write(folder_ / "open/train/plot.png", "mine, too");
  const std::vector<DatasetFinding> findings = Findings();
  EXPECT_FALSE(AnyFault(findings));
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].where, (folder_ / "NOTES.md").string());
  EXPECT_EQ(findings[1].where, (folder_ / "open/train/plot.png").string());
  EXPECT_EQ(FindingsToJson(findings).at("findings").at(0).at("severity"), "note");
}

TEST_F(DamagedDatasetTest, AReadmeOfTheUsersIsKeptAndTakenAsItIsWhenAskedTo) {
  Write(folder_ / "README.md", "my own words\n");
  EXPECT_TRUE(Names(folder_ / "README.md"));
  EXPECT_THROW(WriteDatasetCard(folder_), Error);
  EXPECT_EQ(ReadFile(folder_ / "README.md"), "my own words\n");
  CollectInto(folder_);  // goes on in a finished dataset
  EXPECT_EQ(ReadFile(folder_ / "README.md"), "my own words\n");
  WriteDatasetCard(folder_, OldReadme::kKeep);
  EXPECT_EQ(ReadFile(folder_ / "README.md"), "my own words\n");
  EXPECT_TRUE(Findings().empty());
  Write(folder_ / "README.md", "other words\n");
  WriteDatasetCard(folder_, OldReadme::kReplace);
  EXPECT_NE(ReadFile(folder_ / "README.md").find("# Door episodes"), std::string::npos);
  EXPECT_TRUE(Findings().empty());
}

TEST_F(DamagedDatasetTest, TheSameCommandMendsWhatIsMadeFromShardsAndPlan) {
  for (const char* record : {"dataset.json", "failures.jsonl", "provenance.json", "SHA256SUMS",
                             "splits/train.txt", "splits/val.txt"}) {
    const std::string sound = ReadFile(folder_ / record);
    Write(folder_ / record, sound.substr(0, sound.size() / 2) + "?");
    CollectInto(folder_);
    EXPECT_EQ(ReadFile(folder_ / record), sound) << record;
    EXPECT_TRUE(Findings().empty()) << record;
  }
}

TEST_F(DamagedDatasetTest, ADamagedProvenanceIsNotMergedIntoAnother) {
  const std::string sound = ReadFile(folder_ / "provenance.json");
  Write(folder_ / "provenance.json", WithOtherDigit(sound, "seed"));
  EXPECT_THROW(MergeDataset({folder_, {}}), Error);
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

TEST(FindingsText, TellsFaultsFromNotes) {
  const DatasetFinding fault{"DST001", "a.tar", "7 bytes", "8 bytes", "copy it again"};
  const DatasetFinding note{"DST014", "b.txt", "no part of it", "", "", DatasetSeverity::kNote};
  EXPECT_EQ(FindingsText({note, fault}, "data/"),
            "note    b.txt: no part of it\n"
            "DST001  a.tar\n"
            "        found   7 bytes\n"
            "        allowed 8 bytes\n"
            "        fix     copy it again\n"
            "data/: 1 faults\n");
  EXPECT_EQ(FindingsText({note}, "data"), "note    b.txt: no part of it\ndata: no faults\n");
}

TEST_F(VerifyDatasetTest, CountsTheShardsThatItWillCheck) {
  EXPECT_EQ(CountShards(folder_), plan_.shards.size());
  EXPECT_THROW(CountShards(folder_ / "nothing"), Error);
}

}  // namespace
}  // namespace doorforge

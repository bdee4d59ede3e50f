// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/shard.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

#include "shard_fixture.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using fixture::FlipBit;
using fixture::MakeEpisode;
using fixture::MembersOf;
using fixture::Slurp;
using fixture::Spill;

class Shard : public fixture::FolderTest {
 protected:
  ShardCommit Write(int episodes, std::uint64_t first = 0) {
    ShardWriter writer(folder_, {3, "open", "train", "c0ffee"});
    for (int i = 0; i < episodes; ++i) {
      const Episode episode = MakeEpisode(first + static_cast<std::uint64_t>(i));
      writer.Add("ep" + std::to_string(100000 + i), episode.decisions.size(), MembersOf(episode));
    }
    writer.AddFailure({"ep200000", "door_9", "grip_lost", "at 0.3 rad", 0.3, 0.7});
    return writer.Commit();
  }

  fs::path tar() const { return folder_ / "shard-000003.tar"; }
  fs::path index() const { return folder_ / "shard-000003.index.json"; }

  // What the constructor says about a damaged shard.
  std::string Complaint() const {
    try {
      const ShardReader reader(index());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Shard, ReadsBackWhatWasWritten) {
  EXPECT_EQ(Write(4), ShardCommit::kWritten);
  const ShardReader reader(index());
  ASSERT_EQ(reader.index().episodes.size(), 4U);
  EXPECT_EQ(reader.index().header.stage, "open");
  EXPECT_EQ(reader.index().header.config_sha256, "c0ffee");
  EXPECT_EQ(reader.index().failures.at(0).outcome, "grip_lost");
  EXPECT_EQ(reader.index().tar_sha256, Sha256OfFile(tar()));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(reader.index().episodes[i].decisions, 3U);
    for (const MemberBytes& member : MembersOf(MakeEpisode(i))) {
      const auto bytes = reader.Read(i, member.name);
      EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                member.bytes);
    }
  }
  EXPECT_TRUE(reader.FindFaults().empty());
  EXPECT_THROW(static_cast<void>(reader.Read(0, "preview.png")), Error);
  EXPECT_THROW(static_cast<void>(reader.Read(4, "cloud.npy")), Error);
}

TEST_F(Shard, LeavesNothingBehindUnlessCommitted) {
  {
    ShardWriter writer(folder_, {0, "open", "train", ""});
    writer.Add("ep0", 3, MembersOf(MakeEpisode(0)));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  Write(1);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(Shard, AcceptsASecondWriterOnlyWithTheSameBytes) {
  EXPECT_EQ(Write(2), ShardCommit::kWritten);
  const std::string before = Slurp(tar());
  EXPECT_EQ(Write(2), ShardCommit::kAlreadyThere);
  try {
    Write(2, 50);
    ADD_FAILURE() << "a different shard was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_NE(std::string(error.what()).find("already committed with other content"),
              std::string::npos);
  }
  EXPECT_EQ(Slurp(tar()), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(Shard, ReplacesTheTarOfACrashedWriter) {
  Spill(tar(), "half a tar");
  EXPECT_EQ(Write(2), ShardCommit::kWritten);
  EXPECT_TRUE(ShardReader(index()).FindFaults().empty());
}

TEST_F(Shard, MayHoldNoEpisodes) {
  Write(0);
  const ShardReader reader(index());
  EXPECT_TRUE(reader.index().episodes.empty());
  EXPECT_TRUE(reader.FindFaults().empty());
  EXPECT_EQ(fs::file_size(tar()), 1024U);
}

TEST_F(Shard, RefusesKeysAndMembersThatReadersWouldMisread) {
  ShardWriter writer(folder_, {0, "open", "train", ""});
  EXPECT_THROW(writer.Add("ep.0", 1, {{"a.npy", "x"}}), Error);
  EXPECT_THROW(writer.Add("", 1, {{"a.npy", "x"}}), Error);
  EXPECT_THROW(writer.Add("../ep", 1, {{"a.npy", "x"}}), Error);
  EXPECT_THROW(writer.Add("ep1", 1, {{"noextension", "x"}}), Error);
  writer.Add("ep2", 1, {{"b.npy", "x"}, {"a.npy", "x"}});
  EXPECT_THROW(writer.Add("ep2", 1, {{"a.npy", "x"}, {"b.npy", "x"}}), Error);
  EXPECT_THROW(writer.Add("ep3", 1, {{"a.npy", "x"}}), Error);
  EXPECT_THROW(ShardWriter(folder_, {1000000, "", "", ""}), Error);
}

TEST_F(Shard, NoticesEveryFlippedBitWhenAMemberIsRead) {
  Write(2);
  const ShardIndex before = ReadShardIndex(index());
  for (const ShardMember& member : before.episodes[1].members) {
    const std::uint64_t byte = member.offset + member.size / 2;
    FlipBit(tar(), byte);
    const ShardReader reader(index());
    try {
      static_cast<void>(reader.Read(1, member.name));
      ADD_FAILURE() << member.name << ": damage was not noticed";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      const std::string message = error.what();
      EXPECT_NE(message.find("shard-000003.tar: ep100001." + member.name), std::string::npos);
      EXPECT_NE(message.find("are damaged"), std::string::npos);
    }
    EXPECT_NO_THROW(static_cast<void>(reader.Read(0, member.name)));
    EXPECT_NO_THROW(static_cast<void>(ShardReader(index(), CrcCheck::kNever).Read(1, member.name)));
    EXPECT_EQ(reader.FindFaults().size(), 2U);  // the member and the whole
    FlipBit(tar(), byte);
  }
}

TEST_F(Shard, NoticesDamageOutsideTheMembers) {
  Write(2);
  FlipBit(tar(), 10);  // in the first header
  const std::vector<std::string> faults = ShardReader(index()).FindFaults();
  ASSERT_FALSE(faults.empty());
  EXPECT_NE(faults[0].find("no valid header at byte 0"), std::string::npos) << faults[0];
}

TEST_F(Shard, NamesACutFileAndBothSizes) {
  Write(3);
  const std::uintmax_t size = fs::file_size(tar());
  fs::resize_file(tar(), size * 6 / 10);
  EXPECT_NE(Complaint().find(std::to_string(size * 6 / 10) + " bytes, its index says " +
                             std::to_string(size)),
            std::string::npos)
      << Complaint();
  fs::remove(tar());
  EXPECT_NE(Complaint().find("no such file"), std::string::npos);
}

TEST_F(Shard, GivesUpItsCompleteEpisodesAfterACut) {
  Write(10);
  const ShardIndex whole = ReadShardIndex(index());
  fs::remove(index());
  fs::resize_file(tar(), fs::file_size(tar()) * 6 / 10);
  const RecoveredShard recovered = RecoverShard(tar());
  ASSERT_EQ(recovered.index.episodes.size(), 6U);
  EXPECT_LE(recovered.incomplete_keys.size(), 1U);
  EXPECT_NE(recovered.fault.find("cut off"), std::string::npos);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(recovered.index.episodes[i].key, whole.episodes[i].key);
    EXPECT_EQ(recovered.index.episodes[i].decisions, 3U);
    for (std::size_t m = 0; m < whole.episodes[i].members.size(); ++m)
      EXPECT_EQ(recovered.index.episodes[i].members[m].crc32c, whole.episodes[i].members[m].crc32c);
  }
}

TEST_F(Shard, RecoversFromCutsAnywhere) {
  Write(2);
  const std::string bytes = Slurp(tar());
  std::size_t most = 0;
  for (std::size_t length = 0; length <= bytes.size(); length += 257) {
    Spill(tar(), bytes.substr(0, length));
    const std::size_t found = RecoverShard(tar()).index.episodes.size();
    EXPECT_GE(found, most);
    most = std::max(most, found);
  }
  EXPECT_EQ(most, 2U);
}

class ShardIndexRecord : public Shard {
 protected:
  void SetUp() override {
    Shard::SetUp();
    Write(2);
    json_ = nlohmann::ordered_json::parse(Slurp(index()));
    json_.erase("index_crc32c");  // of the text, not of the record
  }
  std::string Rejection() const {
    try {
      ShardIndexFromJson(json_, "index");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      return error.what();
    }
    return "";
  }
  nlohmann::ordered_json& Member(int i) { return json_["episodes"][0]["members"][i]; }
  nlohmann::ordered_json json_;
};

TEST_F(ShardIndexRecord, SurvivesARoundTrip) {
  EXPECT_EQ(ShardIndexToJson(ShardIndexFromJson(json_, "index")), json_);
}

TEST_F(ShardIndexRecord, MayNotPointOutsideTheTar) {
  json_["tar"] = "../shard-000003.tar";
  EXPECT_NE(Rejection().find("expected shard-000003.tar"), std::string::npos) << Rejection();
}

TEST_F(ShardIndexRecord, MayNotReachBeyondTheTar) {
  json_["episodes"][1]["members"].back()["size"] = std::uint64_t{1} << 40;
  EXPECT_NE(Rejection().find("reaches beyond"), std::string::npos) << Rejection();
  json_["episodes"][1]["members"].back()["offset"] = ~std::uint64_t{511};
  EXPECT_NE(Rejection().find("reaches beyond"), std::string::npos) << Rejection();
}

TEST_F(ShardIndexRecord, MayNotHaveOverlappingMembers) {
  Member(1)["offset"] = Member(0)["offset"];
  EXPECT_NE(Rejection().find("overlaps"), std::string::npos) << Rejection();
}

TEST_F(ShardIndexRecord, MayNotRepeatAKeyOrDropAMember) {
  nlohmann::ordered_json kept = json_;
  json_["episodes"][1]["key"] = json_["episodes"][0]["key"];
  EXPECT_NE(Rejection().find("occurs twice"), std::string::npos) << Rejection();
  json_ = kept;
  json_["episodes"][1]["members"].erase(2);
  EXPECT_NE(Rejection().find("has other members than"), std::string::npos) << Rejection();
}

TEST_F(ShardIndexRecord, IsRefusedFromAnUnknownVersion) {
  json_["schema_version"] = kShardSchemaVersion + 1;
  EXPECT_NE(Rejection().find("this build reads"), std::string::npos) << Rejection();
}

TEST_F(ShardIndexRecord, NeverCrashesOnRemovedOrWrongFields) {
  const nlohmann::ordered_json kept = json_;
  for (const auto& [key, unused] : kept.items()) {
    json_ = kept;
    json_.erase(key);
    EXPECT_NE(Rejection(), "") << key;
    for (const nlohmann::ordered_json& wrong :
         {nlohmann::ordered_json(-1), nlohmann::ordered_json("x"),
          nlohmann::ordered_json(nullptr)}) {
      json_ = kept;
      json_[key] = wrong;
      Rejection();
    }
  }
}

}  // namespace
}  // namespace doorforge

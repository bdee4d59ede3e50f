// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/collect_stage.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/collect/collection_script.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/dataset.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class CollectStageTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("doorforge_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "doors/door");
    DoorAsset door = MakePrimitiveDoor({});
    door.id = "door";
    door.body.id = "body";
    door.handle.id = "handle";
    door.body.sha256 = "body";
    door.handle.sha256 = "handle";
    WriteDoor(door, folder_ / "doors/door");
  }
  void TearDown() override { fs::remove_all(folder_); }

  CollectStageRequest RequestFor(std::uint64_t episodes) const {
    CollectStageRequest request;
    request.stage.config = DefaultsOf(Stage::kOpen);
    request.stage.config.episodes = episodes;
    request.stage.config.seed = 4;
    request.stage.config.cloud.point_count = 64;
    request.stage.config.collection.val_fraction = 0;
    request.stage.config.preview = false;
    request.stage.doors = {(folder_ / "doors").string()};
    request.stage.threads = 2;
    request.out = folder_ / "data";
    return request;
  }

  CollectionScriptRequest ScriptFor(const std::vector<std::string>& arguments) const {
    CollectionScriptRequest request;
    request.stage = RequestFor(20).stage;
    request.stage.config.collection.episodes_per_shard = 4;
    request.file = folder_ / "collect.sh";
    request.script.program = "/opt/doorforge";
    request.script.work_folder = "/";
    request.script.dataset = (folder_ / "data/").string();
    request.script.arguments = arguments;
    request.script.tasks = 0;
    return request;
  }

  static std::uint64_t EpisodesOf(const fs::path& data) {
    const DatasetPart part = ReadDataset(data).parts.at(0);
    return part.episodes + part.failed_episodes;
  }

  template <class Request>
  static std::string Refusal(const Request& request, ErrorCode code) {
    try {
      if constexpr (std::is_same_v<Request, CollectStageRequest>)
        CollectStage(request);
      else
        WriteCollectionScript(request);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    return "nothing was refused";
  }

  fs::path folder_;
};

TEST_F(CollectStageTest, GoesOnInADatasetOfTheSameSettingsAndReplacesOnlyWhenAsked) {
  const CollectSummary first = CollectStage(RequestFor(3));
  EXPECT_EQ(first.kept_shards, 0U);
  const CollectSummary again = CollectStage(RequestFor(3));
  EXPECT_EQ(again.kept_shards, again.shards);

  CollectStageRequest other = RequestFor(2);
  EXPECT_NE(Refusal(other, ErrorCode::kInvalidArgument).find("episodes"), std::string::npos);
  EXPECT_EQ(EpisodesOf(folder_ / "data"), 3U);
  other.replace = true;
  CollectStage(other);
  EXPECT_EQ(EpisodesOf(folder_ / "data"), 2U);
}

TEST_F(CollectStageTest, WhatIsNoDatasetStaysAsItIs) {
  CollectStageRequest request = RequestFor(1);
  request.replace = true;
  request.out = folder_ / "doors";
  EXPECT_NE(Refusal(request, ErrorCode::kInvalidArgument).find("holds no dataset"),
            std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "doors/door/door.json"));

  fs::create_directories(folder_ / "settings");
  std::ofstream(folder_ / "settings/config.yaml") << "mine: true\n";
  request.out = folder_ / "settings";
  EXPECT_NE(Refusal(request, ErrorCode::kInvalidArgument).find("settings"), std::string::npos);
  EXPECT_EQ(ReadFile(folder_ / "settings/config.yaml"), "mine: true\n");

  request.out = folder_ / "doors/door/door.json";
  EXPECT_NE(Refusal(request, ErrorCode::kInvalidArgument).find("is a file"), std::string::npos);
}

// a decision of 1,000,000 points takes 13 MB, an episode that opens has about 16 of them
TEST_F(CollectStageTest, WarnsOfADiskThatMayBecomeFullAndRefusesOneThatWill) {
  struct Told {
    std::string text;
  };
  const double free_bytes = static_cast<double>(fs::space(folder_).available);
  const auto episodes_for = [&](double share) {
    return static_cast<std::uint64_t>(std::ceil(share * free_bytes / (16 * 13e6)));
  };
  const auto request_for = [&](double share) {
    CollectStageRequest request = RequestFor(episodes_for(share));
    request.stage.config.cloud.point_count = 1000000;
    request.warn = [](const std::string& text) { throw Told{text}; };
    return request;
  };
  try {
    CollectStage(request_for(2));
    ADD_FAILURE() << "nothing was said";
  } catch (const Told& told) {
    EXPECT_NE(told.text.find("make room"), std::string::npos) << told.text;
  }
  EXPECT_NE(Refusal(request_for(8), ErrorCode::kIo).find("make room"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "data"));
}

TEST_F(CollectStageTest, AScriptsTaskGetsWhatIsItsOwnOfTheCall) {
  const CollectionScript script = WriteCollectionScript(ScriptFor(
      {"datagen", "open", "--slurm", "collect.sh", "--doors", "my doors", "-j4", "--tasks=3",
       "--slurm-option", "--mem=1G", "--submit", "--out", "data", "--json", "--overwrite"}));
  EXPECT_EQ(script.shards, 5U);
  EXPECT_EQ(script.tasks, 5);  // one a shard where none are given
  EXPECT_EQ(script.arrays, 1U);
  const std::string text = ReadFile(folder_ / "collect.sh");
  EXPECT_NE(text.find(" 'datagen' 'open' '--doors' 'my doors' '--out' 'data'"), std::string::npos)
      << text;
  for (const char* word : {"--slurm", "-j4", "--tasks=3", "--submit", "'--json'", "--overwrite"})
    EXPECT_EQ(text.find(word), std::string::npos) << word << "\n" << text;
  EXPECT_NE(text.find("dataset='" + (folder_ / "data").string() + "'"), std::string::npos) << text;
  EXPECT_FALSE(fs::exists(folder_ / "data"));
}

TEST_F(CollectStageTest, AScriptReplacesNoOtherFile) {
  CollectionScriptRequest request = ScriptFor({"datagen", "open"});
  WriteCollectionScript(request);
  WriteCollectionScript(request);  // the same again
  request.script.memory = "3G";
  const std::string before = ReadFile(request.file);
  EXPECT_NE(Refusal(request, ErrorCode::kInvalidArgument).find("is another file"),
            std::string::npos);
  EXPECT_EQ(ReadFile(request.file), before);
  request.replace = true;
  WriteCollectionScript(request);
  EXPECT_NE(ReadFile(request.file), before);
}

TEST_F(CollectStageTest, AScriptRunsThisProgramHereUnlessItIsTold) {
  CollectionScriptRequest request = ScriptFor({"datagen", "open"});
  request.script.program = "";
  request.script.work_folder = "";
  const CollectionScript script = WriteCollectionScript(request);
  EXPECT_EQ(ScriptText(script, "s.sh"), "s.sh: 5 tasks of 5 shards in 1 arrays");
  const std::string text = ReadFile(request.file);
  EXPECT_NE(text.find((ProgramFolder() / "doorforge").string()), std::string::npos) << text;
  EXPECT_NE(text.find(fs::current_path().string()), std::string::npos) << text;
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/collect.h"

#include <csignal>
#include <set>
#include <stdexcept>

#include <sys/wait.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "synthetic.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using synthetic::CollectionTest;
using synthetic::HashesBelow;

TEST_F(CollectionTest, WritesSuccessesIntoShardsAndFailuresIntoALog) {
  const CollectSummary summary = CollectInto(folder_);
  EXPECT_EQ(summary.planned, 40U);
  EXPECT_EQ(summary.written, 34U);  // every seventh fails from 3 on: 3, 10, ..., 38
  EXPECT_EQ(summary.failures.at("grip_lost"), 6U);
  EXPECT_EQ(summary.kept_shards, 0U);

  std::set<std::string> keys;
  for (const char* split : {"train", "val"}) {
    const DatasetReader reader(folder_, "open", split);
    for (std::size_t i = 0; i < reader.size(); ++i) {
      keys.insert(reader.entry(i).key);
      EXPECT_EQ(reader.Meta(i).at("success"), true);
    }
  }
  EXPECT_EQ(keys.size(), 34U);
  EXPECT_EQ(keys.count("ep000003"), 0U);
  const std::string failures = [&] {
    std::ifstream file(folder_ / "failures.jsonl");
    return std::string(std::istreambuf_iterator<char>(file), {});
  }();
  EXPECT_NE(failures.find("\"key\":\"ep000003\""), std::string::npos);
  EXPECT_NE(failures.find("synthetic ep000038"), std::string::npos);
}

TEST_F(CollectionTest, AnEpisodeInWhichThereWasNothingToDecideIsNoData) {
  const CollectSummary summary = Collect(
      plan_,
      [this](const PlannedEpisode& planned) {
        CollectedEpisode collected = synthetic::RunSynthetic(planned, doors_);
        if (planned.number == 5) collected.episode.decisions.clear();
        return collected;
      },
      RequestFor(folder_, 2));
  EXPECT_EQ(summary.written, 33U);
  EXPECT_EQ(summary.failures.at("no_decisions"), 1U);
}

TEST_F(CollectionTest, WritesTheSameBytesForAnyNumberOfThreads) {
  CollectInto(folder_ / "one", 1);
  CollectInto(folder_ / "five", 5);
  const auto one = HashesBelow(folder_ / "one");
  EXPECT_EQ(one, HashesBelow(folder_ / "five"));
  EXPECT_TRUE(one.count("dataset.json") == 1 && one.count("splits/val.txt") == 1);
  EXPECT_EQ(one.count("open/val/shard-000000.tar"), 1U);
}

TEST_F(CollectionTest, GoesOnAfterAKillWithTheSameBytes) {
  CollectInto(folder_ / "whole");
  const auto whole = HashesBelow(folder_ / "whole");
  // each child goes on where the one before was killed; a shard is 8 episodes
  for (const int last_episode : {3, 9, 0, 11, 7, 8}) {
    const pid_t child = ::fork();
    if (child == 0) {
      int run = 0;
      Collect(
          plan_,
          [&](const PlannedEpisode& planned) {
            if (++run > last_episode) ::raise(SIGKILL);
            return synthetic::RunSynthetic(planned, doors_);
          },
          RequestFor(folder_ / "killed", 1));
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
  }
  EXPECT_FALSE(fs::exists(folder_ / "killed/dataset.json"));
  const CollectSummary summary = CollectInto(folder_ / "killed", 3);
  EXPECT_GT(summary.kept_shards, 0U);
  EXPECT_EQ(HashesBelow(folder_ / "killed"), whole);
}

TEST_F(CollectionTest, KeepsCommittedShardsUntouched) {
  CollectInto(folder_);
  const auto before = fs::last_write_time(folder_ / "open/train/shard-000001.tar");
  fs::remove(folder_ / "open/train/shard-000000.index.json");
  const CollectSummary summary = CollectInto(folder_);
  EXPECT_EQ(summary.kept_shards, plan_.shards.size() - 1);
  EXPECT_EQ(fs::last_write_time(folder_ / "open/train/shard-000001.tar"), before);
}

TEST_F(CollectionTest, RefusesAFolderOfAnotherConfigAndNamesTheDifference) {
  CollectInto(folder_);
  CollectRequest request = RequestFor(folder_, 1);
  request.config_text = "{\"seed\": 12}\n";
  try {
    Collect(
        plan_, [&](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); },
        request);
    ADD_FAILURE();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("\n  seed: recorded 11, given 12"), std::string::npos) << message;
  }
}

TEST_F(CollectionTest, CountsAnEpisodeThatCannotBeRunAndGoesOn) {
  const CollectSummary summary = Collect(
      plan_,
      [&](const PlannedEpisode& planned) {
        if (planned.number == 5) throw Error(ErrorCode::kInvalidArgument, "no such pose");
        CollectedEpisode collected = synthetic::RunSynthetic(planned, doors_);
        if (planned.number == 6) collected.episode.decisions[1].action[0] = NAN;
        return collected;
      },
      RequestFor(folder_, 2));
  EXPECT_EQ(summary.failures.at("error"), 2U);
  EXPECT_EQ(summary.written, 32U);
}

TEST_F(CollectionTest, EndsWithTheErrorOfABrokenRunner) {
  EXPECT_THROW(Collect(
                   plan_,
                   [](const PlannedEpisode& planned) -> CollectedEpisode {
                     throw std::logic_error(planned.key);
                   },
                   RequestFor(folder_, 2)),
               std::logic_error);
  EXPECT_FALSE(fs::exists(folder_ / "dataset.json"));
}

TEST_F(CollectionTest, PutsTheDoorsOfEachSplitIntoAFile) {
  CollectInto(folder_);
  std::set<std::string> ids;
  for (const char* split : {"train", "val"}) {
    std::ifstream file(folder_ / "splits" / (std::string(split) + ".txt"));
    for (std::string line; std::getline(file, line);) EXPECT_TRUE(ids.insert(line).second) << line;
  }
  EXPECT_EQ(ids.size(), doors_.size());
}

// What names thousands of doors of which nobody saw an episode grows with the folder of doors and
// not with the data: it was 12 MB for 40 episodes of ten thousand doors.
TEST_F(CollectionTest, ASmallDatasetOfManyDoorsNamesThoseOfItsEpisodesAlone) {
  doors_ = synthetic::Doors(1000);
  Rng rng(3, "shapes");
  for (DoorParts& door : doors_)
    for (PartIdentity* part : {&door.body, &door.handle})
      for (int i = 0; i < 13; ++i) part->shape.push_back(rng.Uniform(0, 1));
  plan_ = MakePlan(doors_, 40, 11, {.episodes_per_shard = 8, .val_fraction = 0.2});
  CollectInto(folder_);
  std::map<std::string, std::string> seen;  // door to split
  std::map<std::string, PartIdentity> bodies;
  for (const DoorParts& door : doors_) bodies[door.door_id] = door.body;
  for (const char* split : {"train", "val"}) {
    const DatasetReader reader(folder_, "open", split);
    for (std::size_t i = 0; i < reader.size(); ++i)
      seen[reader.Meta(i).at("scene").at("door_id")] = split;
    for (const fs::path& index : ShardIndices(folder_, "open", split))
      for (const FailedEpisode& failure : ReadShardIndex(index).failures)
        seen[failure.door_id] = split;
  }
  EXPECT_EQ(seen.size(), 40U);
  const fs::path path = folder_ / "provenance.json";
  EXPECT_LE(fs::file_size(path), 100'000U);
  std::map<std::string, std::string> named;
  for (const DatasetDoor& door : ProvenanceFromJson(ReadJsonFile(path), path.string()).doors) {
    named[door.id] = door.split;
    EXPECT_EQ(door.body.shape, bodies.at(door.id).shape);
  }
  EXPECT_EQ(named, seen);
}

}  // namespace
}  // namespace doorforge

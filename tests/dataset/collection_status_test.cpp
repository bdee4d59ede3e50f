// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/collection_status.h"

#include <chrono>

#include "doorforge/core/error.h"
#include "doorforge/dataset/merge_dataset.h"
#include "doorforge/schemas/shard_progress.h"

#include "encoded_episode.h"
#include "synthetic.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using synthetic::HashesBelow;

// 40 episodes in shards of 8, of which every seventh fails from 3 on.
class CollectionStatusTest : public synthetic::CollectionTest {
 protected:
  void CollectTask(int number, int count) const {
    CollectRequest request = RequestFor(folder_, 1);
    request.task = {number, count};
    Collect(
        plan_, [this](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); },
        request);
  }

  // A writer that has come so far with a shard of the plan, and holds it.
  std::unique_ptr<ShardWriter> Begin(std::size_t place, std::size_t episodes) const {
    const PlannedShard& shard = plan_.shards.at(place);
    const CollectRequest request = RequestFor(folder_, 1);
    auto writer = std::make_unique<ShardWriter>(
        folder_ / "open" / shard.split,
        ShardHeader{shard.number, "open", shard.split, Sha256Hex(request.config_text)},
        Unfinished::kKeep);
    for (std::size_t i = 0; i < episodes; ++i) AddTo(*writer, shard.episodes.at(i));
    return writer;
  }

  void AddTo(ShardWriter& writer, const PlannedEpisode& planned) const {
    const CollectRequest request = RequestFor(folder_, 1);
    EncodedEpisode encoded = RunAndEncode(
        planned, request.provenance.doors.at(planned.door),
        [this](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); });
    if (encoded.failure)
      writer.AddFailure(std::move(*encoded.failure));
    else
      writer.Add(planned.key, encoded.decisions, std::move(encoded.members));
  }

  std::uint64_t FailuresIn(std::size_t place, std::size_t episodes) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < episodes; ++i)
      count += plan_.shards.at(place).episodes.at(i).number % 7 == 3 ? 1 : 0;
    return count;
  }

  CollectionStatus Look(double seconds_from_now = 0, int tasks = 0) const {
    return StatusOfCollection({{folder_}, tasks, Now() + seconds_from_now});
  }

  static double Now() {
    using Seconds = std::chrono::duration<double>;
    return Seconds(std::chrono::system_clock::now().time_since_epoch()).count();
  }

  // As if the last episode of each shard had come so much later.
  void Delay(std::chrono::seconds delay) const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".index.json") || name.ends_with(".journal"))
        fs::last_write_time(entry.path(), fs::file_time_type::clock::now() + delay);
    }
  }
};

TEST_F(CollectionStatusTest, CountsWhatIsDoneBeingWrittenAndOpen) {
  CollectTask(0, 2);  // shards 0, 2 and 4 of the plan's five
  const auto writer = Begin(1, 5);
  const CollectionStatus status = Look();
  EXPECT_FALSE(status.is_complete);
  EXPECT_EQ(status.Count(ShardState::kDone), 3U);
  EXPECT_EQ(status.Count(ShardState::kBeingWritten), 1U);
  EXPECT_EQ(status.Count(ShardState::kOpen), 1U);
  EXPECT_EQ(status.Planned(), 40U);
  const std::uint64_t failed =
      FailuresIn(0, 8) + FailuresIn(1, 5) + FailuresIn(2, 8) + FailuresIn(4, 8);
  EXPECT_EQ(status.Failed(), failed);
  EXPECT_EQ(status.Kept(), 29 - failed);
  EXPECT_EQ(status.failures, (std::map<std::string, std::uint64_t>{{"grip_lost", failed}}));
  EXPECT_DOUBLE_EQ(status.SuccessRate().value(), 1 - static_cast<double>(failed) / 29);
  EXPECT_EQ(status.Slowest()->place, 1U);
  EXPECT_NE(StatusText(status, Now()).find("3 of 5 done, 1 being written, 1 open"),
            std::string::npos);
}

TEST_F(CollectionStatusTest, WatchingEndsWithTheLastShard) {
  CollectTask(0, 2);
  std::vector<std::size_t> done;
  const auto show = [&](const CollectionStatus& status, double now_s) {
    EXPECT_NEAR(now_s, Now(), 60);
    done.push_back(status.Count(ShardState::kDone));
    if (done.size() == 1) CollectTask(1, 2);  // meanwhile
  };
  const std::optional<CollectionStatus> last =
      WatchCollection({.folders = {folder_}}, std::chrono::milliseconds(1), show);
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(done, (std::vector<std::size_t>{3, 5}));
  EXPECT_EQ(last->Count(ShardState::kDone), 5U);
}

TEST_F(CollectionStatusTest, AWriterGoesOnUnharmed) {
  CollectTask(0, 2);
  auto writer = Begin(1, 5);
  const auto before = HashesBelow(folder_);
  Look();
  EXPECT_EQ(HashesBelow(folder_), before);
  for (std::size_t i = 5; i < 8; ++i) AddTo(*writer, plan_.shards[1].episodes[i]);
  EXPECT_EQ(writer->Commit(), ShardCommit::kWritten);
  writer.reset();
  EXPECT_EQ(Look().Count(ShardState::kDone), 4U);
}

TEST_F(CollectionStatusTest, ALineOfAJournalThatIsHalfWrittenIsNotThereYet) {
  CollectTask(0, 2);
  Begin(1, 5).reset();
  const fs::path journal =
      ShardJournalPath(folder_ / "open" / plan_.shards[1].split, plan_.shards[1].number);
  fs::resize_file(journal, fs::file_size(journal) - 7);
  const CollectionStatus status = Look();
  EXPECT_EQ(status.shards[1].kept + status.shards[1].failed, 4U);
}

TEST_F(CollectionStatusTest, RateAndTimeLeftAreThoseOfAllTasksTogether) {
  CollectTask(0, 2);
  const auto writer = Begin(1, 5);
  Delay(std::chrono::seconds(100));
  CollectionStatus status = Look(100);
  EXPECT_NEAR(status.episodes_per_s.value(), 29 / 100.0, 0.01);  // made within some milliseconds
  EXPECT_NEAR(status.SecondsLeft().value(), 11 / (29 / 100.0), 2);
  Delay(std::chrono::hours(2));  // as fast as in the last of the two hours
  status = Look(7200);
  EXPECT_NEAR(status.episodes_per_s.value() * 7200, 29, 0.1);
}

TEST_F(CollectionStatusTest, AShardWithoutNewsForTenOfItsEpisodesCountsAsLeft) {
  CollectTask(0, 2);
  Begin(1, 5).reset();
  Delay(std::chrono::seconds(100));  // an episode took 25 s
  EXPECT_EQ(Look(100 + 200).shards[1].state, ShardState::kBeingWritten);
  const CollectionStatus status = Look(100 + 300, 2);
  EXPECT_EQ(status.shards[1].state, ShardState::kBegun);
  EXPECT_FALSE(status.SecondsLeft());
  const std::string text = StatusText(status, Now());
  EXPECT_NE(text.find("nobody writes; the same `datagen` command goes on"), std::string::npos);
  EXPECT_NE(text.find(status.shards[1].name + " (number 1, task 1/2)"), std::string::npos) << text;
}

TEST_F(CollectionStatusTest, TellsTheTasksApartIfTheirNumberIsGiven) {
  CollectTask(0, 2);
  const auto writer = Begin(1, 5);
  const CollectionStatus status = Look(0, 2);
  ASSERT_EQ(status.tasks.size(), 2U);
  EXPECT_EQ(status.tasks[0].done_shards, 3U);
  EXPECT_EQ(status.tasks[0].run, 24U);
  EXPECT_EQ(status.tasks[1].run, 5U);
  EXPECT_EQ(status.SlowestTask()->number, 1);
  EXPECT_TRUE(Look().tasks.empty());
}

TEST_F(CollectionStatusTest, IsCompleteOnlyAfterTheMerge) {
  CollectTask(0, 2);
  CollectTask(1, 2);
  CollectionStatus status = Look();
  EXPECT_EQ(status.Count(ShardState::kDone), 5U);
  EXPECT_FALSE(status.is_complete);
  EXPECT_NE(StatusText(status, Now()).find("dataset merge"), std::string::npos);
  MergeDataset({folder_, {}});
  status = Look();
  EXPECT_TRUE(status.is_complete);
  EXPECT_EQ(status.Kept(), 34U);
  EXPECT_EQ(StatusToJson(status, Now()).at("unfinished").size(), 0U);
}

TEST_F(CollectionStatusTest, TasksMayWriteIntoFoldersOfTheirOwn) {
  const fs::path other = folder_.string() + "_other";
  CollectTask(0, 2);
  fs::rename(folder_, other);
  CollectTask(1, 2);
  const CollectionStatus status = StatusOfCollection({{folder_, other}, 0, Now()});
  EXPECT_EQ(status.Count(ShardState::kDone), 5U);
  EXPECT_EQ(Look().Count(ShardState::kDone), 2U);
  fs::remove_all(other);
}

TEST_F(CollectionStatusTest, AFolderWithoutACollectionIsMissing) {
  fs::create_directories(folder_);
  try {
    Look();
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMissing);
  }
}

}  // namespace
}  // namespace doorforge

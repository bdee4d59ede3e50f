// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The writer stopped at each of its file operations in every way, killed at any time, and beside
// another writer: what is committed stays, and going on gives the bytes of an undisturbed run.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include "doorforge/core/error.h"
#include "doorforge/dataset/merge_dataset.h"

#include "faulty_files.h"
#include "synthetic.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using synthetic::Fault;
using synthetic::FaultyFiles;
using synthetic::HashesBelow;

constexpr int kNever = -1;

// Shared with forked writers.
class SharedCounter {
 public:
  SharedCounter()
      : count_(static_cast<int*>(::mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE,
                                        MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {}
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  ~SharedCounter() { ::munmap(count_, sizeof(int)); }
  int& operator*() { return *count_; }

 private:
  int* count_;
};

class FaultTest : public synthetic::CollectionTest {
 protected:
  void SetUp() override {
    CollectionTest::SetUp();
    // two shards of three and one of two; one episode fails
    plan_ = MakePlan(doors_, 8, 11, {.episodes_per_shard = 3, .val_fraction = 0.2});
    fs::create_directories(folder_);
  }

  void CollectWith(FileSystem& files, const fs::path& folder) {
    CollectRequest request = RequestFor(folder, 1);
    request.files = &files;
    Collect(
        plan_,
        [&](const PlannedEpisode& planned) {
          ++*episodes_;
          return synthetic::RunSynthetic(planned, doors_);
        },
        request);
  }

  // Exit code of a process that does this: 0, 1 after an Error, 2 where it would have been killed.
  template <class Work>
  int InAProcess(const Work& work) {
    const pid_t child = ::fork();
    if (child == 0) {
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, STDERR_FILENO);
      try {
        work();
      } catch (const Error&) {
        ::_exit(1);
      } catch (const synthetic::Killed&) {
        ::_exit(2);
      }
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  void StopAtEachOperation(Fault fault) {
    FaultyFiles undisturbed(fault, kNever);
    CollectWith(undisturbed, folder_ / "whole");
    const auto whole = HashesBelow(folder_ / "whole");
    const int operations = undisturbed.operations();
    EXPECT_GT(operations, 60);
    int stopped = 0;
    for (int at = 0; at < operations; ++at) {
      const fs::path folder = folder_ / "stopped";
      fs::remove_all(folder);
      *episodes_ = 0;
      const int end = InAProcess([&] {
        FaultyFiles files(fault, at);
        CollectWith(files, folder);
      });
      stopped += end == 0 ? 0 : 1;
      ASSERT_EQ(InAProcess([&] {
                  FaultyFiles files(fault, kNever);
                  CollectWith(files, folder);
                }),
                0)
          << "operation " << at;
      ASSERT_EQ(HashesBelow(folder), whole) << "operation " << at;
      // of what was made, only the episode at hand was made again
      if (fault != Fault::kPowerCut) {
        EXPECT_LE(*episodes_, 9) << "operation " << at;
      }
    }
    // what cannot fail the run is the removal of what nobody reads
    EXPECT_GE(stopped, operations - 5);
  }

  SharedCounter episodes_;
};

TEST_F(FaultTest, GoesOnAfterARefusalOfEachOperation) { StopAtEachOperation(Fault::kRefused); }

TEST_F(FaultTest, GoesOnAfterADiskWasFullAtEachOperation) { StopAtEachOperation(Fault::kDiskFull); }

TEST_F(FaultTest, GoesOnAfterAKillBeforeEachOperation) { StopAtEachOperation(Fault::kKilled); }

TEST_F(FaultTest, GoesOnAfterAKillWithinEachOperation) { StopAtEachOperation(Fault::kKilledHalf); }

TEST_F(FaultTest, GoesOnAfterAPowerCutBeforeEachOperation) {
  StopAtEachOperation(Fault::kPowerCut);
}

TEST_F(FaultTest, MergesTheSameAfterAKillWithinEachOperation) {
  CollectInto(folder_ / "whole");
  const auto whole = HashesBelow(folder_ / "whole");
  std::vector<fs::path> parts;
  for (int task = 0; task < 2; ++task) {
    parts.push_back(folder_ / ("part" + std::to_string(task)));
    CollectRequest request = RequestFor(parts.back(), 1);
    request.task = {task, 2};
    Collect(
        plan_, [&](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); },
        request);
  }
  for (const bool links : {true, false}) {
    for (int at = 0, end = 2; end == 2; ++at) {
      const fs::path folder = folder_ / "merged";
      fs::remove_all(folder);
      end = InAProcess([&] {
        FaultyFiles files(Fault::kKilledHalf, at);
        if (!links) files.RefuseLinks();
        MergeDataset({folder, parts, &files});
      });
      ASSERT_EQ(InAProcess([&] { MergeDataset({folder, parts}); }), 0) << "operation " << at;
      ASSERT_EQ(HashesBelow(folder), whole) << "operation " << at;
    }
  }
}

TEST_F(FaultTest, NeverGoesOnWithADamagedEpisode) {
  CollectInto(folder_ / "whole");
  const auto whole = HashesBelow(folder_ / "whole");
  const fs::path stopped = folder_ / "stopped";
  EXPECT_THROW(Collect(
                   plan_,
                   [&](const PlannedEpisode& planned) {
                     if (planned.key == plan_.shards[0].episodes[2].key)
                       throw Error(ErrorCode::kIo, "the disk is gone");
                     return synthetic::RunSynthetic(planned, doors_);
                   },
                   RequestFor(stopped, 1)),
               Error);
  std::vector<fs::path> unfinished;
  for (const auto& entry : fs::recursive_directory_iterator(stopped)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".partial") || name.ends_with(".journal"))
      unfinished.push_back(entry.path());
  }
  ASSERT_EQ(unfinished.size(), 2U);
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    const fs::path folder = folder_ / "damaged";
    fs::remove_all(folder);
    fs::copy(stopped, folder, fs::copy_options::recursive);
    const fs::path file =
        folder / fs::relative(unfinished[static_cast<std::size_t>(i) % 2], stopped);
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    const auto at = static_cast<std::streamoff>(random() % fs::file_size(file));
    bytes.seekg(at);
    const int old = bytes.get();
    bytes.seekp(at);
    bytes.put(static_cast<char>(old ^ (1 << random() % 8)));
    bytes.close();
    // a flipped bit in the journal's first line makes it another's; all else is made again
    ASSERT_EQ(InAProcess([&] {
                FaultyFiles files(Fault::kKilled, kNever);
                CollectWith(files, folder);
              }),
              0);
    ASSERT_EQ(HashesBelow(folder), whole) << file << " byte " << at;
  }
}

TEST_F(FaultTest, LetsOneProcessWriteAShard) {
  const ShardHeader header{0, "open", "train", "c"};
  const ShardWriter writer(folder_, header, Unfinished::kKeep);
  try {
    const ShardWriter other(folder_, header, Unfinished::kKeep);
    ADD_FAILURE() << "two writers of one shard";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("another process is writing this shard"),
              std::string::npos);
  }
}

TEST_F(FaultTest, EndsWhereADoorCannotBeReadAndGoesOnWhenItCan) {
  CollectInto(folder_ / "whole");
  for (const ErrorCode code : {ErrorCode::kMissing, ErrorCode::kFormat, ErrorCode::kIo}) {
    const fs::path folder = folder_ / ("code" + std::to_string(static_cast<int>(code)));
    EXPECT_THROW(Collect(
                     plan_,
                     [&](const PlannedEpisode& planned) {
                       if (planned.number == 5) throw Error(code, "door.json: gone");
                       return synthetic::RunSynthetic(planned, doors_);
                     },
                     RequestFor(folder, 1)),
                 Error);
    const CollectSummary summary = CollectInto(folder);
    EXPECT_GT(summary.kept_shards + summary.kept_episodes, 0U);
    EXPECT_EQ(HashesBelow(folder), HashesBelow(folder_ / "whole"));
  }
}

// 200 kills, or as many as $DOORFORGE_KILLS says.
TEST_F(FaultTest, GivesTheSameBytesHoweverOftenItIsKilled) {
  plan_ = MakePlan(doors_, 40, 11, {.episodes_per_shard = 8, .val_fraction = 0.2});
  CollectInto(folder_ / "whole");
  const auto whole = HashesBelow(folder_ / "whole");
  const char* wanted = std::getenv("DOORFORGE_KILLS");
  const int kills = wanted != nullptr ? std::atoi(wanted) : 200;
  std::mt19937 random(7);
  int killed = 0;
  int finished = 0;
  const fs::path folder = folder_ / "killed";
  while (killed < kills) {
    const pid_t child = ::fork();
    if (child == 0) {
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, STDERR_FILENO);
      CollectInto(folder, 1 + static_cast<int>(random() % 2));
      ::_exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 40000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) {
      ++killed;
      continue;
    }
    ASSERT_EQ(WEXITSTATUS(status), 0);
    ASSERT_EQ(HashesBelow(folder), whole) << "after " << killed << " kills";
    fs::remove_all(folder);
    ++finished;
  }
  CollectInto(folder);
  EXPECT_EQ(HashesBelow(folder), whole);
  std::printf("%d kills, %d datasets finished among them\n", killed, finished);
}

}  // namespace
}  // namespace doorforge

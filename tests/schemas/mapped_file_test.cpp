// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Files that another program cuts while they are mapped.

#include "datasets/mapped_file.h"

#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>

#include "doorforge/core/error.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/shard.h"

#include "shard_fixture.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSize = 1 << 20;

class MappedFileTest : public fixture::FolderTest {
 protected:
  fs::path FileOf(const std::string& name, std::size_t size = kSize) const {
    fixture::Spill(folder_ / name, std::string(size, 'x'));
    return folder_ / name;
  }
};

std::size_t SumOf(const MappedFile& file) {
  std::size_t sum = 0;
  for (const std::byte byte : file.bytes()) sum += std::to_integer<std::size_t>(byte);
  return sum;
}

void ExpectRefused(const MappedFile& file, const fs::path& path) {
  try {
    file.RequireWhole();
    ADD_FAILURE() << path << " was taken for whole";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kIo);
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

TEST_F(MappedFileTest, AFileThatNobodyTouchesIsWhole) {
  const MappedFile file(FileOf("a"));
  EXPECT_EQ(SumOf(file), kSize * 'x');
  EXPECT_NO_THROW(file.RequireWhole());
}

// Without the guard this test ends with the signal SIGBUS.
TEST_F(MappedFileTest, WhatIsCutOffReadsAsZerosAndIsRefused) {
  const fs::path path = FileOf("a");
  const MappedFile file(path);
  const MappedFile other(FileOf("b"));
  fs::resize_file(path, kSize / 2);
  EXPECT_EQ(SumOf(file), kSize / 2 * 'x');
  ExpectRefused(file, path);
  fixture::Spill(path, std::string(kSize, 'x'));
  ExpectRefused(file, path);  // what was read in between stays worthless
  EXPECT_EQ(SumOf(other), kSize * 'x');
  EXPECT_NO_THROW(other.RequireWhole());
}

TEST_F(MappedFileTest, AFewBytesLessInTheLastPageAreRefusedToo) {
  const fs::path path = FileOf("a", 5000);
  const MappedFile file(path);
  fs::resize_file(path, 4500);
  SumOf(file);  // no signal: the page is there, with zeros from byte 4500 on
  ExpectRefused(file, path);
}

TEST_F(MappedFileTest, AFileThatTakesThePlaceOfTheMappedOneIsNoDamage) {
  const fs::path path = FileOf("a");
  const MappedFile file(path);
  fs::rename(FileOf("b", 10), path);
  EXPECT_EQ(SumOf(file), kSize * 'x');
  EXPECT_NO_THROW(file.RequireWhole());
}

TEST_F(MappedFileTest, ManyThreadsMayReadManyFilesWhileSomeAreCut) {
  constexpr int kFiles = 150;  // more than one piece of the guard's table
  std::vector<fs::path> paths;
  for (int i = 0; i < kFiles; ++i) paths.push_back(FileOf("f" + std::to_string(i), 1 << 16));
  std::atomic<int> wrong{0};
  for (int round = 0; round < 3; ++round) {
    std::vector<std::unique_ptr<MappedFile>> files;
    for (const fs::path& path : paths) files.push_back(std::make_unique<MappedFile>(path));
    for (int i = round; i < kFiles; i += 3) fs::resize_file(paths[static_cast<std::size_t>(i)], 1);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < kFiles; ++i) {
          const MappedFile& file = *files[static_cast<std::size_t>(i)];
          const bool is_cut = i % 3 == round;
          if (SumOf(file) != (is_cut ? 'x' : (1U << 16) * 'x')) ++wrong;
          const MappedFile fresh(paths[static_cast<std::size_t>(i)]);  // comes and goes meanwhile
          bool whole = true;
          try {
            file.RequireWhole();
          } catch (const Error&) {
            whole = false;
          }
          if (whole == is_cut) ++wrong;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    files.clear();
    for (const fs::path& path : paths) fixture::Spill(path, std::string(1 << 16, 'x'));
  }
  EXPECT_EQ(wrong, 0);
}

// Reads a cut mapping of its own, which no MappedFile guards.
void ReadUnguarded(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY);
  auto* data = static_cast<volatile char*>(::mmap(nullptr, kSize, PROT_READ, MAP_SHARED, file, 0));
  fs::resize_file(path, 0);
  static_cast<void>(data[kSize - 1]);
}

TEST_F(MappedFileTest, ASignalOfAnotherAddressEndsTheProcessAsItAlwaysDid) {
  const MappedFile file(FileOf("guarded"));
  const fs::path path = FileOf("a");
  EXPECT_EXIT(ReadUnguarded(path), testing::KilledBySignal(SIGBUS), "");
  EXPECT_EXIT(::raise(SIGBUS), testing::KilledBySignal(SIGBUS), "");
}

TEST_F(MappedFileTest, ATarThatIsCutUnderItsReaderEndsInAnErrorThatNamesIt) {
  ShardWriter writer(folder_, {0, "open", "train", std::string(64, 'c')});
  for (int i = 0; i < 4; ++i) {
    const Episode episode = fixture::MakeEpisode(static_cast<std::uint64_t>(i), 3, 2000);
    writer.Add("ep" + std::to_string(100000 + i), 3, fixture::MembersOf(episode));
  }
  writer.Commit();
  const fs::path tar = folder_ / "shard-000000.tar";
  const ShardReader reader(folder_ / "shard-000000.index.json");
  const EpisodeArrays last = ViewEpisode(reader, 3);
  const float before = std::accumulate(last.cloud.begin(), last.cloud.end(), 0.0F);
  EXPECT_NO_THROW(reader.RequireWhole());
  fs::resize_file(tar, 8192);
  EXPECT_NE(std::accumulate(last.cloud.begin(), last.cloud.end(), 0.0F), before);
  const auto expect = [&](const std::function<void()>& read) {
    try {
      read();
      ADD_FAILURE() << "the tar was taken for whole";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kIo);
      EXPECT_NE(std::string(error.what()).find(tar.string() + ": was cut"), std::string::npos)
          << error.what();
    }
  };
  expect([&] { reader.RequireWhole(); });
  expect([&] { static_cast<void>(reader.Read(2, "cloud.npy")); });
  expect([&] { ReadEpisodeMeta(reader, 2); });
  expect([&] { static_cast<void>(reader.FindFaults()); });
}

}  // namespace
}  // namespace doorforge

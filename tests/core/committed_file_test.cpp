// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr FolderKind kNote{"a note", "note.json", "a.note"};

class CommittedFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t EntryCount() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(CommittedFile, HoldsWhatWasWrittenAndNothingElseIsLeft) {
  CommitFile(folder_ / "a/b.txt", "one");
  CommitFile(folder_ / "a/b.txt", "two");
  EXPECT_EQ(ReadFile(folder_ / "a/b.txt"), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "a"), fs::directory_iterator()), 1);
}

TEST_F(CommittedFile, RefusesToReplaceUnlessAsked) {
  CommitFile(folder_ / "a", "one", Existing::kRefuse);
  EXPECT_THROW(CommitFile(folder_ / "a", "two", Existing::kRefuse), Error);
  EXPECT_EQ(ReadFile(folder_ / "a"), "one");
  EXPECT_EQ(EntryCount(), 1U);
}

TEST_F(CommittedFile, ReadingAFolderOrAFileTooLargeIsAnError) {
  EXPECT_THROW(ReadFile(folder_), Error);
  CommitFile(folder_ / "a", "12345");
  EXPECT_THROW(ReadFile(folder_ / "a", 4), Error);
}

TEST_F(CommittedFile, AFolderAppearsOnlyWhenCommitted) {
  {
    StagedFolder staged(folder_ / "part", kNote);
    CommitFile(staged.path() / "x", "1");
    EXPECT_FALSE(fs::exists(folder_ / "part"));
  }
  EXPECT_EQ(EntryCount(), 0U) << "an uncommitted folder leaves nothing behind";
  StagedFolder staged(folder_ / "part", kNote);
  CommitFile(staged.path() / "x", "1");
  staged.Commit();
  EXPECT_EQ(ReadFile(folder_ / "part/x"), "1");
  EXPECT_EQ(EntryCount(), 1U);
}

TEST_F(CommittedFile, AFolderIsReplacedAsAWhole) {
  CommitFile(folder_ / "part/old", "1");
  CommitFile(folder_ / "part/note.json", R"({"schema": "a.note"})");
  EXPECT_THROW(StagedFolder(folder_ / "part", kNote, Existing::kRefuse), Error);
  StagedFolder staged(folder_ / "part", kNote, Existing::kReplace);
  CommitFile(staged.path() / "new", "2");
  staged.Commit();
  EXPECT_FALSE(fs::exists(folder_ / "part/old"));
  EXPECT_EQ(ReadFile(folder_ / "part/new"), "2");
  EXPECT_EQ(EntryCount(), 1U);
}

std::string WhyNotReplaced(const fs::path& folder) {
  try {
    StagedFolder(folder, kNote, Existing::kReplace);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return error.what();
  }
  return {};
}

TEST_F(CommittedFile, OnlyAFolderOfOurOwnKindIsReplaced) {
  const fs::path folder = folder_ / "x";
  CommitFile(folder / "precious", "1");
  EXPECT_NE(WhyNotReplaced(folder).find("holds no note.json"), std::string::npos);
  for (const char* other : {R"({"schema": "another.note"})", "{", "", "[]", R"({"schema": 1})"}) {
    CommitFile(folder / "note.json", other);
    EXPECT_NE(WhyNotReplaced(folder).find("another's"), std::string::npos) << other;
  }
  CommitFile(folder_ / "file", "1");
  EXPECT_NE(WhyNotReplaced(folder_ / "file").find("is a file"), std::string::npos);
  fs::create_directory_symlink(folder, folder_ / "link");
  EXPECT_NE(WhyNotReplaced(folder_ / "link").find("is a link"), std::string::npos);
  fs::create_directories(folder_ / "empty");
  EXPECT_NE(WhyNotReplaced(folder_ / "empty").find("holds no note.json"), std::string::npos);
  EXPECT_EQ(ReadFile(folder / "precious"), "1");
  CommitFile(folder / "note.json", R"({"schema": "a.note"})");
  EXPECT_EQ(WhyNotReplaced(folder), "");
}

TEST_F(CommittedFile, AFolderThatBecameAnothersMeanwhileIsNotReplaced) {
  CommitFile(folder_ / "part/note.json", R"({"schema": "a.note"})");
  StagedFolder staged(folder_ / "part", kNote, Existing::kReplace);
  fs::remove(folder_ / "part/note.json");
  CommitFile(folder_ / "part/precious", "1");
  EXPECT_THROW(staged.Commit(), Error);
  EXPECT_EQ(ReadFile(folder_ / "part/precious"), "1");
}

TEST_F(CommittedFile, ABatchReplacesOnlyFoldersOfItsKind) {
  CommitFile(folder_ / "mine/note.json", R"({"schema": "a.note"})");
  CommitFile(folder_ / "other/precious", "1");
  StagedBatch batch(folder_, kNote);
  for (const char* name : {"mine", "new", "other"}) WriteStaged(batch.path() / name / "x", "2");
  EXPECT_THROW(batch.Commit(), Error);
  EXPECT_FALSE(fs::exists(folder_ / "new")) << "refused before anything is put in place";
  fs::remove_all(batch.path() / "other");
  batch.Commit();
  EXPECT_EQ(ReadFile(folder_ / "mine/x"), "2");
  EXPECT_EQ(ReadFile(folder_ / "new/x"), "2");
  EXPECT_EQ(ReadFile(folder_ / "other/precious"), "1");
}

// What a process leaves that is killed while it stages.
void DieStaging(const fs::path& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    new StagedFolder(folder / "part", kNote);
    new StagedBatch(folder, kNote);
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
}

TEST_F(CommittedFile, WhatAKilledWriterLeftIsGoneWhenTheNextOneBegins) {
  DieStaging(folder_);
  ASSERT_EQ(EntryCount(), 2U);
  const StagedBatch batch(folder_, kNote);
  EXPECT_EQ(EntryCount(), 1U) << "its own alone";
}

TEST_F(CommittedFile, WhatIsBeingWrittenIsNotTakenForLeftBehind) {
  const StagedFolder folder(folder_ / "part", kNote);
  const StagedBatch batch(folder_, kNote);
  DieStaging(folder_ / "deeper");
  RemoveStaleFiles(SystemFiles(), folder_);
  EXPECT_TRUE(fs::exists(folder.path()));
  EXPECT_TRUE(fs::exists(batch.path()));
  EXPECT_TRUE(fs::is_empty(folder_ / "deeper"));
}

// Each of these processes begins by removing what is left behind in the folder that the others are
// staging into.
TEST_F(CommittedFile, ManyProcessesMayStageIntoOneFolderAtATime) {
  constexpr int kProcesses = 8;
  constexpr int kRounds = 100;
  std::vector<pid_t> children;
  for (int process = 0; process < kProcesses; ++process) {
    const pid_t child = ::fork();
    if (child != 0) {
      children.push_back(child);
      continue;
    }
    try {
      for (int round = 0; round < kRounds; ++round) {
        const std::string name = std::to_string(process) + "_" + std::to_string(round);
        RemoveStaleFiles(SystemFiles(), folder_);
        StagedFolder staged(folder_ / name, kNote);
        RemoveStaleFiles(SystemFiles(), folder_);
        CommitFile(folder_ / (name + ".txt"), "1");
        staged.Commit();
      }
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      ::_exit(1);
    }
    ::_exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(EntryCount(), static_cast<std::size_t>(2 * kProcesses * kRounds));
}

TEST_F(CommittedFile, AnothersTemporariesStayForADay) {
  const fs::path fresh = folder_ / ".a.tmp-0123456789ab-1-0";
  const fs::path old = folder_ / ".b.tmp-0123456789ab-1-0";
  const fs::path user = folder_ / ".notes.tmp-x-0";
  for (const fs::path& path : {fresh, old, user}) std::ofstream(path) << "x";
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(25));
  fs::last_write_time(user, fs::file_time_type::clock::now() - std::chrono::hours(25));
  RemoveStaleFiles(SystemFiles(), folder_);
  EXPECT_TRUE(fs::exists(fresh));
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(user));
}

TEST_F(CommittedFile, ANameAsLongAsTheSystemAllowsIsWritten) {
  const std::string name(255, 'n');
  CommitFile(folder_ / name, "1");
  EXPECT_EQ(ReadFile(folder_ / name), "1");
  StagedFolder staged(folder_ / std::string(255, 'f'), kNote);
  staged.Commit();
  EXPECT_TRUE(fs::is_directory(folder_ / std::string(255, 'f')));
}

TEST_F(CommittedFile, APlaceWhereNothingCanBeWrittenIsToldBeforehand) {
  RequireWritable(folder_ / "a/b");
  EXPECT_EQ(EntryCount(), 0U) << "trying leaves nothing behind";
  EXPECT_THROW(RequireWritable("/proc/nothing/here"), Error);
  CommitFile(folder_ / "file", "1");
  EXPECT_THROW(RequireWritable(folder_ / "file"), Error);
}

}  // namespace
}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

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
    StagedFolder staged(folder_ / "part");
    CommitFile(staged.path() / "x", "1");
    EXPECT_FALSE(fs::exists(folder_ / "part"));
  }
  EXPECT_EQ(EntryCount(), 0U) << "an uncommitted folder leaves nothing behind";
  StagedFolder staged(folder_ / "part");
  CommitFile(staged.path() / "x", "1");
  staged.Commit();
  EXPECT_EQ(ReadFile(folder_ / "part/x"), "1");
  EXPECT_EQ(EntryCount(), 1U);
}

TEST_F(CommittedFile, AFolderIsReplacedAsAWhole) {
  CommitFile(folder_ / "part/old", "1");
  EXPECT_THROW(StagedFolder(folder_ / "part", Existing::kRefuse), Error);
  StagedFolder staged(folder_ / "part", Existing::kReplace);
  CommitFile(staged.path() / "new", "2");
  staged.Commit();
  EXPECT_FALSE(fs::exists(folder_ / "part/old"));
  EXPECT_EQ(ReadFile(folder_ / "part/new"), "2");
  EXPECT_EQ(EntryCount(), 1U);
}

}  // namespace
}  // namespace doorforge

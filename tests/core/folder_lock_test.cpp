// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/folder_lock.h"

#include <fstream>
#include <optional>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class FolderLockTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
               std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Empty if the lock is to be had.
  std::string Complaint(Writers writers) const {
    try {
      const FolderLock lock(folder_, "the second", writers);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
  }

  // What a child process that tries it ends with: 0 if it got the lock.
  int InAnotherProcess(Writers writers) const {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(Complaint(writers).empty() ? 0 : 1);
    int status = -1;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  bool IsEmpty() const { return fs::is_empty(folder_); }

  fs::path folder_;
};

TEST_F(FolderLockTest, ASecondWriterIsRefusedAndToldWhoTheFirstIs) {
  std::optional<FolderLock> lock(std::in_place, folder_, "doorforge train", Writers::kOne);
  const std::string complaint = Complaint(Writers::kOne);
  EXPECT_NE(
      complaint.find(folder_.string() + ": doorforge train (process " + std::to_string(::getpid())),
      std::string::npos)
      << complaint;
  EXPECT_NE(complaint.find("wait until it has ended, or use another folder"), std::string::npos);
  EXPECT_NE(Complaint(Writers::kTogether), "");
  EXPECT_EQ(InAnotherProcess(Writers::kOne), 1);
  lock.reset();
  EXPECT_TRUE(IsEmpty());
  EXPECT_EQ(InAnotherProcess(Writers::kOne), 0);
  EXPECT_TRUE(IsEmpty());
}

TEST_F(FolderLockTest, TasksWriteTogetherAndTheLastOneTakesTheLockAway) {
  std::optional<FolderLock> one(std::in_place, folder_, "task 0", Writers::kTogether);
  std::optional<FolderLock> two(std::in_place, folder_, "task 1", Writers::kTogether);
  EXPECT_EQ(InAnotherProcess(Writers::kTogether), 0);
  EXPECT_EQ(InAnotherProcess(Writers::kOne), 1);
  one.reset();
  EXPECT_FALSE(IsEmpty());
  EXPECT_EQ(InAnotherProcess(Writers::kOne), 1);
  two.reset();
  EXPECT_TRUE(IsEmpty());
  EXPECT_EQ(Complaint(Writers::kOne), "");
}

TEST_F(FolderLockTest, AKilledWriterHoldsNobodyUpAndNothingOfItIsLeft) {
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder_, "killed", Writers::kOne);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(IsEmpty());
  EXPECT_EQ(Complaint(Writers::kOne), "");
  EXPECT_TRUE(IsEmpty());
}

TEST_F(FolderLockTest, AFolderMadeForNothingGoesAgainAndOneWithSomethingInItStays) {
  const fs::path made = folder_ / "a" / "made";
  { const FolderLock lock(made, "nothing", Writers::kOne); }
  EXPECT_FALSE(fs::exists(made));
  {
    const FolderLock lock(made, "something", Writers::kOne);
    std::ofstream(made / "file") << "x";
  }
  EXPECT_TRUE(fs::exists(made / "file"));
  EXPECT_FALSE(fs::exists(made / FolderLock::kFileName));
}

}  // namespace
}  // namespace doorforge

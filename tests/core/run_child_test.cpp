// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

bool WithinSeconds(double seconds, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return condition();
}

/// Whether a process is there and is no zombie, by /proc.
bool Runs(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return static_cast<bool>(file >> number >> name >> state) && state != "Z";
}

TEST(RunChild, ReturnsTheExitCodeAndTheSignal) {
  EXPECT_EQ(RunChild({"/bin/sh", "-c", "exit 7"}), 7);
  EXPECT_EQ(RunChild({"/bin/sh", "-c", "kill -15 $$"}), 128 + SIGTERM);
}

// `eval --films --json` printed a line of the program that makes the page before its document.
TEST(RunChild, WhatAChildPrintsMayGoAmongTheMessages) {
  const std::vector<std::string> program = {"/bin/sh", "-c", "echo printed"};
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  RunChild(program, ChildOutput::kStandardError);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "printed\n");
  testing::internal::CaptureStdout();
  RunChild(program);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "printed\n");
}

TEST(RunChild, FindsANameOnThePath) { EXPECT_EQ(RunChild({"true"}), 0); }

TEST(RunChild, SaysThatAProgramIsNotThere) {
  try {
    RunChild({"/no/such/program"});
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMissing);
    EXPECT_NE(std::string(error.what()).find("/no/such/program"), std::string::npos);
  }
}

// A benchmark killed in the middle left its evaluation running, which then wrote the folder that
// the next run had begun to make.
TEST(RunChild, WhoIsKilledLeavesNoChildBehind) {
  const fs::path file = fs::temp_directory_path() / ("run_child_" + std::to_string(::getpid()));
  const pid_t parent = ::fork();
  ASSERT_GE(parent, 0);
  if (parent == 0)
    ::_exit(RunChild({"/bin/sh", "-c", "echo $$ > " + file.string() + "; exec sleep 60"}));
  pid_t child = 0;
  ASSERT_TRUE(WithinSeconds(20, [&] { return static_cast<bool>(std::ifstream(file) >> child); }));
  EXPECT_TRUE(Runs(child));
  ::kill(parent, SIGKILL);
  ASSERT_EQ(::waitpid(parent, nullptr, 0), parent);
  EXPECT_TRUE(WithinSeconds(10, [&] { return !Runs(child); })) << "process " << child << " goes on";
  if (Runs(child)) ::kill(child, SIGKILL);
  fs::remove(file);
}

}  // namespace
}  // namespace doorforge

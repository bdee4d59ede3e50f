// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/confine.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 10;
constexpr int kRefused = 11;

/// Something that a file would do which has taken over the process that reads it.
struct Attempt {
  const char* name;
  bool needs_landlock;  ///< A filter of system calls alone does not see it.
  std::function<bool(const fs::path& inside, const fs::path& outside)> succeeds;
};

bool Opens(const fs::path& path, int flags) { return ::open(path.c_str(), flags, 0600) >= 0; }

bool Runs() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  if (child > 0) ::waitpid(child, nullptr, 0);
  return child > 0;
}

bool BecomesAnotherProgram() {
  std::array<char*, 2> arguments{const_cast<char*>("true"), nullptr};
  ::execve("/bin/true", arguments.data(), nullptr);
  return false;  // where it does, this line is not reached and the exit code is another
}

bool MapsCode() {
  return ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) !=
         MAP_FAILED;
}

bool MakesMemoryCode() {
  void* page = ::mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return ::mprotect(page, 4096, PROT_READ | PROT_EXEC) == 0;
}

std::vector<Attempt> Attempts() {
  return {
      {"reads a file elsewhere", true,
       [](const fs::path&, const fs::path& out) { return Opens(out / "secret", O_RDONLY); }},
      {"lists a folder elsewhere", true,
       [](const fs::path&, const fs::path& out) { return Opens(out, O_RDONLY | O_DIRECTORY); }},
      {"reads what a link in its folder leads to", true,
       [](const fs::path& in, const fs::path&) { return Opens(in / "link", O_RDONLY); }},
      {"makes a file in its folder", false,
       [](const fs::path& in, const fs::path&) { return Opens(in / "new", O_WRONLY | O_CREAT); }},
      {"makes a file elsewhere", false,
       [](const fs::path&, const fs::path& out) { return Opens(out / "new", O_WRONLY | O_CREAT); }},
      {"opens its own file to write", false,
       [](const fs::path& in, const fs::path&) { return Opens(in / "mesh", O_RDWR); }},
      {"cuts its own file", false,
       [](const fs::path& in, const fs::path&) {
         return ::truncate((in / "mesh").c_str(), 1) == 0;
       }},
      {"removes a file", false,
       [](const fs::path& in, const fs::path&) { return ::unlink((in / "mesh").c_str()) == 0; }},
      {"renames a file", false,
       [](const fs::path& in, const fs::path&) {
         return ::rename((in / "mesh").c_str(), (in / "other").c_str()) == 0;
       }},
      {"makes a folder", false,
       [](const fs::path& in, const fs::path&) { return ::mkdir((in / "d").c_str(), 0700) == 0; }},
      {"makes a link", false,
       [](const fs::path& in, const fs::path&) {
         return ::symlink("mesh", (in / "another").c_str()) == 0;
       }},
      {"changes rights", false,
       [](const fs::path& in, const fs::path&) {
         return ::chmod((in / "mesh").c_str(), 0777) == 0;
       }},
      {"makes a socket", false,
       [](const fs::path&, const fs::path&) { return ::socket(AF_INET, SOCK_STREAM, 0) >= 0; }},
      {"makes a local socket", false,
       [](const fs::path&, const fs::path&) { return ::socket(AF_UNIX, SOCK_DGRAM, 0) >= 0; }},
      {"starts a process", false, [](const fs::path&, const fs::path&) { return Runs(); }},
      {"becomes another program", false,
       [](const fs::path&, const fs::path&) { return BecomesAnotherProgram(); }},
      {"sends its parent a signal", false,
       [](const fs::path&, const fs::path&) { return ::kill(::getppid(), 0) == 0; }},
      {"lets itself be traced", false,
       [](const fs::path&, const fs::path&) { return ::ptrace(PTRACE_TRACEME, 0, 0, 0) == 0; }},
      {"maps code", false, [](const fs::path&, const fs::path&) { return MapsCode(); }},
      {"makes memory code", false,
       [](const fs::path&, const fs::path&) { return MakesMemoryCode(); }},
      {"takes back a limit", false,
       [](const fs::path&, const fs::path&) {
         rlimit limit{1 << 20, 1 << 20};
         return ::setrlimit(RLIMIT_STACK, &limit) == 0;
       }},
  };
}

class ConfineTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("doorforge_confine_") + test->name());
    Renew();
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path inside() const { return folder_ / "inside"; }
  fs::path outside() const { return folder_ / "outside"; }

  void Renew() {
    fs::remove_all(folder_);
    fs::create_directories(inside());
    fs::create_directories(outside());
    std::ofstream(inside() / "mesh") << "v 0 0 0\n";
    std::ofstream(outside() / "secret") << "secret\n";
    fs::create_symlink(outside() / "secret", inside() / "link");
  }

  // The exit code of a child that does that, confined or not.
  int Tried(bool confined, const std::function<bool()>& succeeds) {
    Renew();
    const pid_t child = ::fork();
    if (child == 0) {
      const std::array readable{inside()};
      if (confined) ConfineToReading(readable);
      try {
        ::_exit(succeeds() ? kDone : kRefused);
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        ::_exit(kRefused);
      }
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  fs::path folder_;
};

TEST_F(ConfineTest, WhoeverTakesTheProcessOverCanDoNothing) {
  const ConfinementSupport kernel = ConfinementOfThisKernel();
  for (const Attempt& attempt : Attempts()) {
    SCOPED_TRACE(attempt.name);
    const auto succeeds = [&] { return attempt.succeeds(inside(), outside()); };
    EXPECT_NE(Tried(false, succeeds), kRefused) << "unconfined it can: else this shows nothing";
    const bool confined = attempt.needs_landlock ? kernel.landlock > 0 : kernel.seccomp;
    if (confined) EXPECT_EQ(Tried(true, succeeds), kRefused);
  }
}

TEST_F(ConfineTest, ReadsComputesAndAnswersAllTheSame) {
  const int pipe = ::open("/dev/null", O_WRONLY);
  const auto works = [&] {
    std::ifstream file(inside() / "mesh");
    std::string word;
    file >> word;
    std::vector<double> numbers(10'000'000, 1.0);  // from the system, not from the heap
    const bool lists = fs::exists(inside() / "mesh") && !fs::exists(inside() / "missing") &&
                       fs::directory_iterator(inside()) != fs::directory_iterator();
    return word == "v" && numbers.back() == 1 && lists && ::write(pipe, "x", 1) == 1;
  };
  EXPECT_EQ(Tried(true, works), kDone);
  ::close(pipe);
}

TEST_F(ConfineTest, SaysWhatItPutUp) {
  const int code = Tried(false, [&] {
    const std::array readable{inside()};
    const ConfinementSupport kernel = ConfinementOfThisKernel();
    const ConfinementSupport put_up = ConfineToReading(readable);
    return put_up.landlock == kernel.landlock && put_up.seccomp == kernel.seccomp;
  });
  EXPECT_EQ(code, kDone);
}

}  // namespace
}  // namespace doorforge::internal

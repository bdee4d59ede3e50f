// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/confined_child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

using Clock = std::chrono::steady_clock;

constexpr rlim_t kOpenFiles = 64;  // a file and what it names, one after the other

// What of the environment the reading program sees: where the loader finds shared libraries that
// lie in no usual place, and in a build with sanitizers what configures those. It reads no other
// variable, and what it reads files for may not know the user's.
constexpr std::array<const char*, 4> kKeptVariables {
  "LD_LIBRARY_PATH",
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
      "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"
#endif
};

std::vector<std::string> ChildEnvironment(const std::vector<std::string>& variables) {
  std::vector<std::string> environment = variables;
  for (const char* name : kKeptVariables) {
    const char* value = name == nullptr ? nullptr : std::getenv(name);
    if (value != nullptr) environment.push_back(std::string(name) + '=' + value);
  }
  return environment;
}

// For the execution functions of POSIX; the texts must outlive it.
std::vector<char*> PointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// The reading process and the end of its pipe. Whatever happens, it is ended and waited for.
class PipedChild {
 public:
  PipedChild(std::vector<std::string>& arguments, const std::vector<std::string>& variables) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
      throw Error(ErrorCode::kIo, std::string("no pipe: ") + std::strerror(errno));
    const int error = Spawn(arguments, variables, ends[1]);
    ::close(ends[1]);
    descriptor_ = ends[0];
    if (error == 0) return;
    ::close(descriptor_);
    throw Error(ErrorCode::kMissing, arguments[0] + ": cannot be started: " + std::strerror(error));
  }

  ~PipedChild() {
    ::close(descriptor_);
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      Wait();
    }
  }

  PipedChild(const PipedChild&) = delete;
  PipedChild& operator=(const PipedChild&) = delete;

  /// Appends what has arrived. False at the end of the message; throws at the deadline.
  bool ReadMore(std::string& message, Clock::time_point deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd poll_entry{descriptor_, POLLIN, 0};
    const int ready =
        left <= 0 ? 0 : ::poll(&poll_entry, 1, static_cast<int>(std::min<long>(left, 1 << 30)));
    if (ready < 0 && errno == EINTR) return true;
    if (ready == 0) throw Error(ErrorCode::kFormat, "reading took longer than the time allowed");
    std::array<char, 1 << 16> buffer{};
    const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) return true;
    if (count > 0) message.append(buffer.data(), static_cast<std::size_t>(count));
    return count > 0;
  }

  /// Status as of waitpid().
  int Wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status;
  }

 private:
  int Spawn(std::vector<std::string>& arguments, const std::vector<std::string>& kept,
            int write_end) {
    std::vector<std::string> variables = ChildEnvironment(kept);
    const std::vector<char*> argv = PointersTo(arguments);
    const std::vector<char*> environment = PointersTo(variables);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, write_end, kAnswerDescriptor);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    // what other code opened without the flag that closes it
    ::posix_spawn_file_actions_addclosefrom_np(&actions, kAnswerDescriptor + 1);
    const int error =
        ::posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environment.data());
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) process_ = 0;
    return error;
  }

  pid_t process_ = 0;
  int descriptor_ = -1;
};

// What the user allows already is never raised, which would be refused.
void Limit(int resource, rlim_t soft, rlim_t hard) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_max = std::min(limit.rlim_max, hard);
  limit.rlim_cur = std::min(limit.rlim_max, soft);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

// Ends with the program that waits for the result: without it nobody would, and a file that is a
// pipe may never end. Where it is gone already, so is the parent.
void EndWith(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(3);
}

// What a file that takes over this process could use is given up before the file is opened.
// Descriptors and environment were left behind by ImportMesh().
void GiveUpRights(bool threads) {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
#if !defined(__SANITIZE_ADDRESS__)  // its search for leaks looks at the process from outside
  ::prctl(PR_SET_DUMPABLE, 0);
#endif
  Limit(RLIMIT_NOFILE, kOpenFiles, kOpenFiles);
  if (!threads) Limit(RLIMIT_NPROC, 0, 0);
}

}  // namespace

ChildAnswer AskChild(std::vector<std::string> arguments, const ChildLimits& limits,
                     const std::vector<std::string>& variables) {
  PipedChild child(arguments, variables);
  const auto deadline =
      Clock::now() + std::chrono::milliseconds(std::llround(limits.seconds * 1000));
  ChildAnswer answer;
  while (child.ReadMore(answer.message, deadline)) {
    if (answer.message.size() <= limits.answer_bytes) continue;
    answer.too_long = true;
    return answer;
  }
  answer.status = child.Wait();
  return answer;
}

std::string SiblingProgram(const std::string& name, const char* variable) {
  if (const char* program = std::getenv(variable)) return program;
  for (const std::filesystem::path& folder : ProgramFolders()) {
    if (std::filesystem::exists(folder / name)) return (folder / name).string();
  }
  throw Error(ErrorCode::kMissing, (ProgramFolder() / name).string() + ": no such program; set " +
                                       variable + " to its path");
}

void ConfineProcess(const ProcessLimits& limits) {
  EndWith(limits.parent);
  GiveUpRights(limits.threads);
#if !defined(__SANITIZE_ADDRESS__)  // its shadow memory alone takes terabytes of address space
  Limit(RLIMIT_AS, limits.memory_bytes, limits.memory_bytes);
#endif
  Limit(RLIMIT_CPU, limits.seconds, limits.seconds + 1);
  Limit(RLIMIT_CORE, 0, 0);
  Limit(RLIMIT_FSIZE, 0, 0);
}

bool SendAnswer(std::string_view message) {
  while (!message.empty()) {
    const ssize_t written = ::write(kAnswerDescriptor, message.data(), message.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    message.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace doorforge

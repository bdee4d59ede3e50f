// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/program.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <sstream>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/stop_signals.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t stop_signal = 0;
timespec stop_time{};  // of the first one

// A terminal's Ctrl-C reaches a child twice: from the terminal, and passed on by its parent.
constexpr double kOnePress = 0.5;  // [s]

void HandleStop(int signal) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  if (stop_signal == 0) {
    stop_time = now;
    stop_signal = signal;
    return;
  }
  const double since = static_cast<double>(now.tv_sec - stop_time.tv_sec) +
                       1e-9 * static_cast<double>(now.tv_nsec - stop_time.tv_nsec);
  if (since > kOnePress) ::_exit(128 + signal);
}

void InstallHandlers() {
  struct sigaction action {};
  action.sa_handler = HandleStop;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

/// Both ends are closed by exec, so that a read returns as soon as the child is another program.
Pipe OpenPipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error(ErrorCode::kIo, std::string("no pipe can be opened: ") + std::strerror(errno));
  return {ends[0], ends[1]};
}

/// In a forked child: becomes the program, or tells through the pipe why it cannot. Whoever kills
/// the parent kills the child as well; it would otherwise go on writing a folder which the next run
/// takes over.
[[noreturn]] void BecomeProgram(const std::vector<std::string>& argv, pid_t parent,
                                const Pipe& failure) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(128 + SIGKILL);  // it died before the line above
  std::vector<char*> arguments;
  arguments.reserve(argv.size() + 1);
  for (const std::string& argument : argv) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  const int cause = errno;
  if (::write(failure.write_end, &cause, sizeof cause) != sizeof cause) ::_exit(126);
  ::_exit(127);
}

int WaitFor(pid_t child, const std::string& name) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(ErrorCode::kIo, name + ": cannot be waited for");
    if (stop_signal != 0) ::kill(child, stop_signal);
  }
  return status;
}

}  // namespace

int RunProgram(const std::function<int()>& body) {
  InstallHandlers();
  try {
    return body();
  } catch (const Error& error) {
    std::fprintf(stderr, "doorforge: %s\n", error.what());
    return ExitCodeOf(error.code());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "doorforge: not enough memory; give less at a time, or fewer --threads\n");
  } catch (const fs::filesystem_error& error) {
    std::fprintf(stderr, "doorforge: %s: %s\n", error.path1().c_str(),
                 error.code().message().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "doorforge: unexpected, please report it: %s\n", error.what());
  }
  return 3;
}

int StopRequested() { return stop_signal; }

StopSignals::StopSignals() {
  stop_signal = 0;
  ::sigaction(SIGINT, nullptr, &interrupt_before_);
  ::sigaction(SIGTERM, nullptr, &terminate_before_);
  InstallHandlers();
}

StopSignals::~StopSignals() {
  ::sigaction(SIGINT, &interrupt_before_, nullptr);
  ::sigaction(SIGTERM, &terminate_before_, nullptr);
  stop_signal = 0;
}

fs::path ProgramFolder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

std::vector<fs::path> ProgramFolders() {
  std::vector<fs::path> folders = {ProgramFolder()};
  const char* path = std::getenv("PATH");
  std::istringstream listed(path == nullptr ? "" : path);
  for (std::string folder; std::getline(listed, folder, ':');) {
    // a name without a slash in front would mean wherever the caller stands
    if (!folder.starts_with('/')) continue;
    std::error_code absent;
    const fs::path front = fs::canonical(fs::path(folder) / "doorforge", absent);
    if (!absent) folders.push_back(front.parent_path());
  }
  return folders;
}

fs::path DataFolder() {
  if (const char* folder = std::getenv("DOORFORGE_DATA")) return folder;
  for (const fs::path& programs : ProgramFolders()) {
    const fs::path folder = (programs / DOORFORGE_DATA_FROM_PROGRAMS).lexically_normal();
    if (fs::is_directory(folder / "robots")) return folder;
  }
  throw Error(ErrorCode::kMissing,
              (ProgramFolder() / DOORFORGE_DATA_FROM_PROGRAMS).lexically_normal().string() +
                  ": no such folder, nor is there one beside a `doorforge` on PATH; set "
                  "DOORFORGE_DATA to the folder that holds catalog/ and robots/");
}

int RunChild(const std::vector<std::string>& argv, ChildOutput output) {
  const Pipe failure = OpenPipe();
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0)
    throw Error(ErrorCode::kIo, argv[0] + ": cannot be started: " + std::strerror(errno));
  if (child == 0) {
    if (output == ChildOutput::kStandardError) ::dup2(STDERR_FILENO, STDOUT_FILENO);
    BecomeProgram(argv, parent, failure);
  }
  ::close(failure.write_end);
  int cause = 0;
  const bool failed = ::read(failure.read_end, &cause, sizeof cause) == sizeof cause;
  ::close(failure.read_end);
  const int status = WaitFor(child, argv[0]);
  if (failed)
    throw Error(ErrorCode::kMissing, argv[0] + ": cannot be started: " + std::strerror(cause));
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace doorforge

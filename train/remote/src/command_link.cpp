// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>

#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

#include "link.h"

extern char** environ;  // NOLINT: POSIX names it so

namespace doorforge::internal {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kMostBytes = 1U << 28;

class CommandLink : public Link {
 public:
  CommandLink(std::string command, double timeout_s)
      : command_(std::move(command)), timeout_s_(timeout_s) {}
  ~CommandLink() override { CommandLink::Close(); }
  CommandLink(const CommandLink&) = delete;
  CommandLink& operator=(const CommandLink&) = delete;

  std::string Open() override {
    if (child_ == 0) Start();
    return "";
  }

  std::string Exchange(const std::string& message) override {
    Open();
    end_ = Clock::now() + std::chrono::milliseconds(static_cast<long>(1000 * timeout_s_));
    const auto size = static_cast<std::uint32_t>(message.size());
    std::string framed;
    for (int shift = 24; shift >= 0; shift -= 8) framed += static_cast<char>(size >> shift & 0xff);
    Send(framed + message);
    std::uint32_t length = 0;
    for (const char byte : Receive(4)) length = length << 8 | static_cast<unsigned char>(byte);
    if (length > kMostBytes)
      throw Failed("its answer is said to have " + std::to_string(length) +
                   " bytes; standard output is for messages alone, print to standard error");
    return Receive(length);
  }

  void Close() override {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
    if (child_ == 0) return;
    // the shell and what it started; whoever ends at the end of its input has a moment for it
    for (int i = 0; i < 20 && !Gone(); ++i) ::usleep(10000);
    ::kill(-child_, SIGKILL);
    if (!gone_) ::waitpid(child_, nullptr, 0);
    child_ = 0;
    gone_ = false;
  }

 private:
  Error Failed(const std::string& problem, ErrorCode code = ErrorCode::kIo) {
    Close();
    return {code, "`" + command_ + "`: " + problem};
  }
  Error Ended() { return Failed("it has ended; what it said is above", ErrorCode::kMissing); }

  bool Gone() {
    if (!gone_) gone_ = ::waitpid(child_, nullptr, WNOHANG) == child_;
    return gone_;
  }

  void Start() {
    // a pair of sockets, since writing into a pipe without a reader would end this program
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw Error(ErrorCode::kIo, std::string("a pair of sockets: ") + std::strerror(errno));
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::string shell = "/bin/sh";
    std::string option = "-c";
    std::array<char*, 4> argv = {shell.data(), option.data(), command_.data(), nullptr};
    const int error =
        ::posix_spawn(&child_, shell.c_str(), &actions, &attributes, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::posix_spawnattr_destroy(&attributes);
    ::close(ends[1]);
    socket_ = ends[0];
    if (error != 0) {
      child_ = 0;
      throw Failed(std::string("cannot be started: ") + std::strerror(error));
    }
  }

  // Waits until the socket can be read or written.
  void Await(short events) {
    pollfd watched{socket_, events, 0};
    while (Clock::now() < end_ && StopRequested() == 0) {
      if (::poll(&watched, 1, 50) > 0) return;
    }
    throw Failed(StopRequested() != 0
                     ? "stopped"
                     : "no answer within " + std::to_string(timeout_s_).substr(0, 5) +
                           " s (--policy-timeout)");
  }

  void Send(const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      Await(POLLOUT);
      const ssize_t count =
          ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
      if (count < 0) throw Ended();
      sent += static_cast<std::size_t>(count);
    }
  }

  std::string Receive(std::size_t size) {
    std::string bytes;
    std::array<char, 65536> part{};
    while (bytes.size() < size) {
      Await(POLLIN);
      const ssize_t count =
          ::recv(socket_, part.data(), std::min(part.size(), size - bytes.size()), MSG_DONTWAIT);
      if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
      if (count <= 0) throw Ended();
      bytes.append(part.data(), static_cast<std::size_t>(count));
    }
    return bytes;
  }

  std::string command_;
  double timeout_s_;
  Clock::time_point end_;
  pid_t child_ = 0;
  bool gone_ = false;
  int socket_ = -1;
};

}  // namespace

std::unique_ptr<Link> MakeCommandLink(const std::string& command, double timeout_s) {
  return std::make_unique<CommandLink>(command, timeout_s);
}

}  // namespace doorforge::internal

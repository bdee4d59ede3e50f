// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge::benchmarks {

inline void Replace(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
    text.replace(at, what.size(), by), at += by.size();
}

inline double SecondsOf(const rusage& usage) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Runs a command by the shell, silent, and returns its CPU time [s]; it is killed after `most_s`
/// of it. Throws Error(kIo) where no process can be made.
inline double RunLimited(const std::string& command, rlim_t most_s) {
  const pid_t child = fork();
  Require(child >= 0, ErrorCode::kIo, "no process for a peer");
  if (child == 0) {
    const rlimit cpu{most_s, most_s};
    setrlimit(RLIMIT_CPU, &cpu);
    if (std::freopen("/dev/null", "w", stdout) == nullptr ||
        std::freopen("/dev/null", "w", stderr) == nullptr)
      _exit(126);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  return SecondsOf(usage);
}

}  // namespace doorforge::benchmarks

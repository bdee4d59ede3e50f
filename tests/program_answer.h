// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace doorforge {

/// What a program printed, and how it ended.
struct ProgramAnswer {
  int code = 0;
  std::string text;
};

/// Runs a shell command and reads its standard output; "2>&1" in it adds what it complains of.
inline ProgramAnswer AnswerOf(const std::string& command) {
  ProgramAnswer answer;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {-1, "the command could not be started"};
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    answer.text.append(buffer.data(), count);
  answer.code = WEXITSTATUS(::pclose(pipe));
  return answer;
}

}  // namespace doorforge

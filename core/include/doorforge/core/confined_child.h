// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Programs that read what strangers made are started with nothing but their arguments and a pipe,
// and give up what else they could use before they open a file.

namespace doorforge {

/// The descriptor that a child writes its answer to.
inline constexpr int kAnswerDescriptor = 3;

struct ChildLimits {
  double seconds = 60;                       ///< Wall clock.
  std::uint64_t answer_bytes = 2ULL << 30U;  ///< A longer answer ends the child.
};

struct ChildAnswer {
  std::string message;    ///< What it wrote to kAnswerDescriptor.
  int status = 0;         ///< It is what waitpid() says; meaningless where the answer is too long.
  bool too_long = false;  ///< It was ended because of ChildLimits::answer_bytes.
};

/// Starts a program (arguments[0] is its path) with its standard streams closed and an environment
/// of LD_LIBRARY_PATH and `variables` ("NAME=value") alone, and waits for its answer. Whatever
/// happens, the child is ended and waited for. May be called from several threads.
/// Throws Error(kMissing) if it cannot be started, Error(kIo) without a pipe, Error(kFormat)
/// "reading took longer than the time allowed".
ChildAnswer AskChild(std::vector<std::string> arguments, const ChildLimits& limits,
                     const std::vector<std::string>& variables = {});

/// A program that lies beside the running one or in another of ProgramFolders(), or that an
/// environment variable names. Throws Error(kMissing).
std::string SiblingProgram(const std::string& name, const char* variable);

struct ProcessLimits {
  std::uint64_t memory_bytes = 2ULL << 30U;  ///< Address space.
  std::uint64_t seconds = 60;                ///< Processor time.
  int parent = 0;                            ///< Process that it ends with.
  bool threads = false;                      ///< It may start threads.
};

/// For the child, before it opens what it was asked about: it ends with its parent, gains no
/// rights, opens few files, starts nothing, writes no file and no core dump.
void ConfineProcess(const ProcessLimits& limits);

/// Writes the child's answer; false where nobody reads it.
bool SendAnswer(std::string_view message);

}  // namespace doorforge

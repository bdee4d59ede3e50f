// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace doorforge {

/// A verb as the front program offers it.
struct FrontVerb {
  const char* name;
  const char* program;  ///< File beside the front program that runs it; empty: `run` does.
  const char* does;     ///< What it does, in the list of verbs.
  int (*run)(int argc, char** argv) = nullptr;
};

/// A program that runs those of its verbs.
struct FrontProgram {
  const char* name;
  const char* about;
  const char* example;  ///< Last lines of the help.
  std::span<const FrontVerb> verbs;
};

/// Runs `NAME VERB ...`: starts the program of the verb in the place of this process, or lists the
/// verbs, prints the version, or the description that kDescribeCommand wants. A build that lacks a
/// program does not list its verbs. The verb's program is told by GLIBC_TUNABLES to keep its memory
/// in large pages, unless that variable is set. Returns the exit code; errors are told as
/// RunProgram() does.
int RunFrontProgram(const FrontProgram& front, int argc, char** argv);

}  // namespace doorforge

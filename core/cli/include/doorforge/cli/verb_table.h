// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace doorforge {

/// One verb of a program: its name, and what runs it. argv[0] is the verb, the result the exit
/// code.
struct Verb {
  const char* name;
  int (*run)(int argc, char** argv);
};

/// The body of a `main` whose first argument is one of the verbs. Errors become messages and exit
/// codes as RunProgram() says; an unknown verb is refused with the nearest one that there is.
int RunVerbs(std::span<const Verb> verbs, int argc, char** argv);

/// The body of a `main` with a single verb, whose name may come first or be left out.
int RunOneVerb(const Verb& verb, int argc, char** argv);

/// Throws Error(kInvalidArgument), which names the nearest of the known verbs.
[[noreturn]] void RefuseVerb(const std::string& name, const std::vector<std::string>& known);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/verb_table.h"

#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

int RunVerb(std::span<const Verb> verbs, int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    if (name == verb.name) return verb.run(argc - 1, argv + 1);
    names.emplace_back(verb.name);
  }
  RefuseVerb(name, names);
}

}  // namespace

int RunVerbs(std::span<const Verb> verbs, int argc, char** argv) {
  return RunProgram([&] { return RunVerb(verbs, argc, argv); });
}

int RunOneVerb(const Verb& verb, int argc, char** argv) {
  const bool has_verb = argc > 1 && argv[1] == std::string_view(verb.name);
  return RunProgram([&] { return has_verb ? verb.run(argc - 1, argv + 1) : verb.run(argc, argv); });
}

void RefuseVerb(const std::string& name, const std::vector<std::string>& known) {
  throw Error(ErrorCode::kInvalidArgument, "unknown verb \"" + name + "\"; did you mean \"" +
                                               NearestName(name, known) +
                                               "\"? `doorforge --help` lists all");
}

}  // namespace doorforge

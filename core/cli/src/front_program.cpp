// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/front_program.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

std::vector<FrontVerb> BuiltVerbs(const FrontProgram& front) {
  std::vector<FrontVerb> built;
  for (const FrontVerb& verb : front.verbs) {
    if (std::filesystem::exists(ProgramFolder() / verb.program)) built.push_back(verb);
  }
  return built;
}

void PrintDescription(const FrontProgram& front) {
  nlohmann::ordered_json verbs = nlohmann::ordered_json::array();
  for (const FrontVerb& verb : BuiltVerbs(front))
    verbs.push_back({{"name", verb.name}, {"program", verb.program}, {"about", verb.does}});
  PrintText(nlohmann::ordered_json{{"name", front.name},
                                   {"about", front.about},
                                   {"footer", front.example},
                                   {"options",
                                    {{{"names", {"-h", "--help"}}, {"about", "lists the verbs"}},
                                     {{"names", {"--version"}}, {"about", "version and commit"}}}},
                                   {"verbs", verbs}}
                .dump(2) +
            "\n");
}

void PrintHelp(const FrontProgram& front) {
  std::printf("%s %s: %s\n\nusage: %s VERB [ARGUMENTS]     %s VERB --help\n\n", front.name,
              CodeVersion().c_str(), front.about, front.name, front.name);
  for (const FrontVerb& verb : BuiltVerbs(front)) std::printf("  %-13s %s\n", verb.name, verb.does);
  std::printf("\n%s\n", front.example);
}

const FrontVerb& FindVerb(const FrontProgram& front, const std::string& name) {
  if (name.starts_with('-'))
    throw Error(ErrorCode::kInvalidArgument, "unknown option \"" + name + "\"; did you mean \"" +
                                                 NearestName(name, {"--help", "--version"}) +
                                                 "\"? `" + front.name + " --help` lists all");
  std::vector<std::string> names;
  for (const FrontVerb& verb : front.verbs) {
    if (name == verb.name) return verb;
    names.emplace_back(verb.name);
  }
  RefuseVerb(name, names);
}

// Doors, clouds and meshes are many small blocks, and with pages of 4 KiB imports and collection
// take about a tenth more time. glibc (2.35 and later) asks for large ones only if it is told so
// before the program starts; what its caller told it stands.
void AskForLargePages() { ::setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 0); }

int Run(const FrontProgram& front, int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "--help";
  if (name == "--help" || name == "-h" || name == "help") {
    PrintHelp(front);
    return 0;
  }
  if (name == kDescribeCommand) {
    PrintDescription(front);
    return 0;
  }
  if (name == "--version") {
    PrintText(CodeVersion() + "\n");
    return 0;
  }
  const FrontVerb& verb = FindVerb(front, name);
  if (verb.run != nullptr) return verb.run(argc - 1, argv + 1);
  const std::string program = (ProgramFolder() / verb.program).string();
  AskForLargePages();
  ::execv(program.c_str(), argv);
  throw Error(ErrorCode::kMissing, program + ": cannot be started: " + std::strerror(errno) +
                                       "; this build lacks the room that offers `" + name + "`");
}

}  // namespace

int RunFrontProgram(const FrontProgram& front, int argc, char** argv) {
  return RunProgram([&] { return Run(front, argc, argv); });
}

}  // namespace doorforge

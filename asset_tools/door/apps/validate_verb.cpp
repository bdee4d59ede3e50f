// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "validate_verb.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/door/validate_door.h"

#include "verb_options.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> paths;
  std::string profile = "physics";
  int threads = 0;
  bool json = false;
  bool rules = false;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Checks doors and parts and reports every fault at once.", "doorforge validate");
  app.add_option("PATH", options.paths, "folders of doors or parts, or folders that hold some");
  app.add_option("--profile", options.profile,
                 "urdf: what loading needs; physics: all rules (default)")
      ->check(CLI::IsMember({"urdf", "physics"}));
  app.add_option("--threads", options.threads, "0: all processors");
  app.add_flag("--json", options.json, "print one JSON document");
  app.add_flag("--rules", options.rules, "list the rules and end");
  app.footer(
      "exit code: 0 without errors, 1 with errors, 3 if a path could not be read\n"
      "example:\n"
      "  doorforge validate doors --json");
  ParseVerb(app, argc, argv);
  if (options.paths.empty() && !options.rules)
    throw Error(ErrorCode::kInvalidArgument, "PATH is required; see `doorforge validate --help`");
  return options;
}

int ListRules() {
  for (const ValidationRule& rule : ValidationRules())
    std::printf("%s %-7s %s\n", std::string(rule.code).c_str(),
                std::string(NameOf(rule.severity)).c_str(), std::string(rule.text).c_str());
  return 0;
}

void Print(const ValidationReport& report) {
  if (report.findings.empty()) return;
  std::printf("%s: %d errors, %d warnings\n", report.folder.c_str(), report.errors,
              report.warnings);
  for (const Finding& finding : report.findings)
    std::printf("  %s %-7s %s\n    measured %s; allowed %s; to fix: %s\n", finding.code.c_str(),
                NameOf(finding.severity).data(), finding.where.c_str(), finding.measured.c_str(),
                finding.allowed.c_str(), finding.fix.c_str());
}

}  // namespace

int RunValidateVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  if (options.rules) return ListRules();
  const auto profile =
      options.profile == "urdf" ? ValidationProfile::kUrdf : ValidationProfile::kPhysics;
  std::vector<fs::path> folders;
  bool unreadable = false;
  for (const std::string& path : options.paths) {
    try {
      for (fs::path& folder : FindRecords(path)) folders.push_back(std::move(folder));
    } catch (const Error& error) {
      std::fprintf(stderr, "doorforge: %s\n", error.what());
      unreadable = true;
    }
  }
  std::vector<ValidationReport> reports(folders.size());
  Progress progress("validating", folders.size());
  ParallelFor(folders.size(), options.threads, [&](std::size_t i) {
    reports[i] = Validate(folders[i], profile);
    progress.Advance();
  });
  int errors = 0;
  int warnings = 0;
  for (const ValidationReport& report : reports) {
    errors += report.errors;
    warnings += report.warnings;
    if (!options.json) Print(report);
  }
  if (options.json)
    std::cout << ToJson(reports).dump(2) << '\n';
  else
    std::printf("%zu folders: %d errors, %d warnings\n", reports.size(), errors, warnings);
  if (unreadable) return 3;
  return errors == 0 ? 0 : 1;
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/mesh/work_budget.h"

#include "validator.h"
#ifdef DOORFORGE_WITH_OPENABLE
#include "doorforge/openable/openable_check.h"
#endif
#include "doorforge/validate/validate_folders.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct ValidateOptions {
  std::vector<std::string> paths;
  std::string profile = "physics";
  int threads = 0;
  double max_seconds = kObjectSeconds;
  int expect = -1;  // -1: any number
  bool json = false;
  bool rules = false;
  bool fix = false;
  bool dry_run = false;
};

ValidateOptions ParseValidate(int argc, char** argv) {
  ValidateOptions options;
  CLI::App app("Checks doors and parts and reports every fault at once.", "doorforge validate");
  app.add_option("PATH", options.paths, "folders of doors or parts, or folders that hold some");
  app.add_option("--profile", options.profile,
                 "urdf: what loading needs; physics: all but simulation (default); openable: all, "
                 "with every door simulated")
      ->check(CLI::IsMember({"urdf", "physics", "openable"}));
  auto* fix = app.add_flag("--fix", options.fix,
                           "mend what can be mended, then validate; --rules says which");
  app.add_flag("--dry-run", options.dry_run, "with --fix: show what would be mended")->needs(fix);
  AddThreads(app, options.threads);
  AddMaxSeconds(app, options.max_seconds);
  app.add_option("--expect", options.expect,
                 "how many doors and parts there are to check; exit code 4 if it is another number")
      ->check(CLI::Range(1, 1'000'000'000));
  AddJson(app, options.json);
  app.add_flag("--rules", options.rules, "list the rules and end");
  app.footer(
      "exit code: 0 without errors, 1 with errors, 3 if a path could not be read or written, a\n"
      "record is missing or nothing was found to check, 4 if it was not as many as --expect says\n"
      "examples:\n"
      "  doorforge validate doors --json\n"
      "  doorforge validate doors --expect 40\n"
      "  doorforge validate --rules --json");
  ParseVerb(app, argc, argv);
  if (options.paths.empty() && !options.rules)
    throw Error(ErrorCode::kInvalidArgument, "PATH is required; see `doorforge validate --help`");
  return options;
}

int ListRules(bool json) {
  if (json) {
    PrintJson(RulesToJson());
    return 0;
  }
  for (const ValidationRule& rule : ValidationRules())
    std::printf("%s %-7s %-7s %s\n", std::string(rule.code).c_str(),
                std::string(NameOf(rule.severity)).c_str(), rule.fixable ? "fixable" : "",
                std::string(rule.text).c_str());
  return 0;
}

void Print(const ValidationReport& report) {
  if (report.findings.empty()) return;
  std::printf("%s: %s\n", report.folder.c_str(),
              CountedFindings(report.errors, report.warnings).c_str());
  for (const Finding& finding : report.findings)
    std::printf("  %s %-7s %s\n    measured %s; allowed %s; to fix: %s\n", finding.code.c_str(),
                NameOf(finding.severity).data(), finding.where.c_str(), finding.measured.c_str(),
                finding.allowed.c_str(), finding.fix.c_str());
}

std::unique_ptr<DoorValidator> ValidatorFor(const std::string& profile) {
  if (profile == "urdf") return std::make_unique<DoorValidator>(ValidationProfile::kUrdf);
  if (profile == "physics") return std::make_unique<DoorValidator>(ValidationProfile::kPhysics);
  auto validator = OpenableValidator();
  if (validator == nullptr)
    throw Error(ErrorCode::kInvalidArgument,
                "--profile openable: this build lacks the simulation (sim/rollout)");
  return validator;
}

void PrintFixes(const FixReport& report, bool dry_run) {
  for (const Fix& fix : report.fixes)
    std::printf("%s: %s %s: %s: %s\n", report.folder.c_str(), dry_run ? "would fix" : "fixed",
                fix.code.c_str(), fix.where.c_str(), fix.done.c_str());
}

std::string Summary(std::size_t checked, std::size_t missing, const std::string& counts) {
  if (checked == 0)
    return "nothing checked" + (missing == 0 ? "" : ": " + Counted(missing, "record") + " missing");
  return Counted(checked, "folder") +
         (missing == 0 ? "" : ", " + std::to_string(missing) + " missing") + ": " + counts;
}

void PrintReports(const ValidateOptions& options, const RecordsFound& found,
                  std::span<const CheckedFolder> checked) {
  if (options.json) return PrintJson(CheckedToJson(checked, found.missing, options.fix));
  int errors = 0;
  int warnings = 0;
  std::size_t count = 0;
  for (const CheckedFolder& folder : checked) PrintFixes(folder.fixes, options.dry_run);
  for (const CheckedFolder& folder : checked) {
    if (!folder.report) continue;
    ++count;
    errors += folder.report->errors;
    warnings += folder.report->warnings;
    Print(*folder.report);
  }
  std::printf("%s\n",
              Summary(count, found.missing.size(), CountedFindings(errors, warnings)).c_str());
}

void SayMissing(const RecordsFound& found) {
  for (const MissingRecord& record : found.missing)
    std::fprintf(stderr,
                 "doorforge: %s: %s is missing, and %s says that it was there; compose or import "
                 "it again, or take away what names it\n",
                 record.folder.c_str(), record.record.c_str(), record.told_by.c_str());
  if (found.folders.empty() && found.missing.empty())
    std::fprintf(stderr,
                 "doorforge: nothing checked: give the folder of a door or part, or one that holds "
                 "some, as `doorforge compose` and `doorforge import` write them\n");
}

int Finish(const ValidateOptions& options, const RecordsFound& found,
           std::span<const CheckedFolder> checked) {
  std::size_t reports = 0;
  bool errors = false;
  bool unreadable = !found.problems.empty();
  for (const CheckedFolder& folder : checked) {
    if (!folder.problem.empty()) std::fprintf(stderr, "doorforge: %s\n", folder.problem.c_str());
    unreadable = unreadable || !folder.problem.empty();
    reports += folder.report ? 1 : 0;
    errors = errors || (folder.report && folder.report->errors > 0);
  }
  PrintReports(options, found, checked);
  if (StopRequested() != 0) {
    std::fprintf(stderr, "doorforge: stopped after %zu of %zu folders\n", reports, checked.size());
    return 128 + StopRequested();
  }
  SayMissing(found);
  if (unreadable || !found.missing.empty() || reports == 0) return 3;
  if (options.expect >= 0 && reports != static_cast<std::size_t>(options.expect)) {
    std::fprintf(stderr, "doorforge: %s checked, expected %d (--expect)\n",
                 Counted(reports, "folder").c_str(), options.expect);
    return 4;
  }
  return errors ? 1 : 0;
}

}  // namespace

std::unique_ptr<DoorValidator> OpenableValidator() {
#ifdef DOORFORGE_WITH_OPENABLE
  return std::make_unique<DoorValidator>(OpenableCheck());
#else
  return nullptr;
#endif
}

int RunValidateVerb(int argc, char** argv) {
  const ValidateOptions options = ParseValidate(argc, argv);
  if (options.rules) return ListRules(options.json);
  const RecordsFound found = FindAllRecords(options.paths);
  for (const std::string& problem : found.problems)
    std::fprintf(stderr, "doorforge: %s\n", problem.c_str());
  FolderChecks checks{.threads = options.threads, .max_seconds = options.max_seconds};
  if (options.fix) checks.fix = options.dry_run ? FixMode::kDryRun : FixMode::kWrite;
  return Finish(options, found,
                ValidateFolders(*ValidatorFor(options.profile), found.folders, checks));
}

}  // namespace doorforge

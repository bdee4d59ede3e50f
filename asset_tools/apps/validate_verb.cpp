// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "validate_verb.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/mesh/work_budget.h"
#include "doorforge/validate/fix_door.h"
#include "doorforge/validate/validate_door.h"

#include "missing_records.h"
#ifdef DOORFORGE_WITH_OPENABLE
#include "openable_check.h"
#endif

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
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

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Checks doors and parts and reports every fault at once.", "doorforge validate");
  app.add_option("PATH", options.paths, "folders of doors or parts, or folders that hold some");
  app.add_option("--profile", options.profile,
                 "urdf: what loading needs; physics: all but simulation (default); openable: all, "
                 "with every door simulated")
      ->check(CLI::IsMember({"urdf", "physics", "openable"}));
  auto* fix = app.add_flag("--fix", options.fix,
                           "mend what can be mended, then validate; --rules says which");
  app.add_flag("--dry-run", options.dry_run, "with --fix: show what would be mended")->needs(fix);
  app.add_option("--threads", options.threads, "0: all processors");
  AddMaxSeconds(app, options.max_seconds);
  app.add_option("--expect", options.expect,
                 "how many doors and parts there are to check; exit code 4 if it is another number")
      ->check(CLI::Range(1, 1'000'000'000));
  app.add_flag("--json", options.json, "print one JSON document");
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

nlohmann::ordered_json RulesToJson() {
  auto rules = nlohmann::ordered_json::array();
  for (const ValidationRule& rule : ValidationRules()) {
    nlohmann::ordered_json entry = {{"code", rule.code},       {"severity", NameOf(rule.severity)},
                                    {"text", rule.text},       {"limit", nullptr},
                                    {"allowed", rule.allowed}, {"fix", rule.fix},
                                    {"fixable", rule.fixable}};
    // `allowed` has a mark where the limit goes
    if (rule.allowed.find("{}") != std::string_view::npos) entry["limit"] = rule.limit;
    entry["allowed"] = AllowedText(rule);
    rules.push_back(std::move(entry));
  }
  return {{"schema", "doorforge.validation_rules"}, {"schema_version", 1}, {"rules", rules}};
}

int ListRules(bool json) {
  if (json) {
    std::cout << JsonText(RulesToJson(), 2) << '\n';
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

/// What there is to check, and what there should be.
struct Found {
  std::vector<fs::path> folders;
  std::vector<MissingRecord> missing;
  bool unreadable = false;  ///< A path, or what should tell of missing records.
};

/// What came of the folders; empty where a stop request came first.
struct Results {
  std::vector<std::optional<ValidationReport>> reports;
  std::vector<FixReport> fixes;
  std::vector<std::string> problems;
};

void FixOne(const Options& options, const fs::path& folder, std::size_t i, Results& results) {
  try {
    results.fixes[i] = FixFolder(folder, options.dry_run ? FixMode::kDryRun : FixMode::kWrite);
  } catch (const std::exception&) {
    results.problems[i] = CurrentProblem(folder.string());
  }
}

// A folder whose record went away meanwhile costs its own report alone.
void ValidateOne(const DoorValidator& validator, const fs::path& folder, std::size_t i,
                 Results& results) {
  try {
    results.reports[i] = validator.Validate(folder);
  } catch (const std::exception&) {
    results.problems[i] = CurrentProblem(folder.string());
  }
}

Results ValidateAll(const Options& options, const std::vector<fs::path>& folders) {
  const std::unique_ptr<DoorValidator> validator = ValidatorFor(options.profile);
  Results results{std::vector<std::optional<ValidationReport>>(folders.size()),
                  std::vector<FixReport>(folders.size()), std::vector<std::string>(folders.size())};
  Progress progress("validating", folders.size());
  ParallelFor(folders.size(), options.threads, [&](std::size_t i) {
    if (StopRequested() != 0) return;
    const WorkBudget budget(folders[i].string(), options.max_seconds);
    if (options.fix) FixOne(options, folders[i], i, results);
    ValidateOne(*validator, folders[i], i, results);
    progress.Advance();
  });
  return results;
}

void PrintFixes(const FixReport& report, bool dry_run) {
  for (const Fix& fix : report.fixes)
    std::printf("%s: %s %s: %s: %s\n", report.folder.c_str(), dry_run ? "would fix" : "fixed",
                fix.code.c_str(), fix.where.c_str(), fix.done.c_str());
}

nlohmann::ordered_json FixesToJson(const Results& results) {
  auto fixes = nlohmann::ordered_json::array();
  for (const FixReport& report : results.fixes) {
    for (const Fix& fix : report.fixes)
      fixes.push_back({{"folder", report.folder.string()},
                       {"code", fix.code},
                       {"where", fix.where},
                       {"done", fix.done},
                       {"written", report.written}});
  }
  return fixes;
}

// The fix report knows why --fix could not mend a fixable finding.
void ExplainLeft(const FixReport& fixed, ValidationReport& report) {
  for (Finding& finding : report.findings) {
    for (const Finding& left : fixed.left) {
      if (finding.code == left.code && finding.where == left.where) finding.fix = left.fix;
    }
  }
}

nlohmann::ordered_json MissingToJson(const std::vector<MissingRecord>& missing) {
  auto json = nlohmann::ordered_json::array();
  for (const MissingRecord& record : missing)
    json.push_back({{"folder", record.folder.string()},
                    {"record", record.record},
                    {"told_by", record.told_by}});
  return json;
}

std::string Summary(std::size_t checked, std::size_t missing, const std::string& counts) {
  if (checked == 0)
    return "nothing checked" + (missing == 0 ? "" : ": " + Counted(missing, "record") + " missing");
  return Counted(checked, "folder") +
         (missing == 0 ? "" : ", " + std::to_string(missing) + " missing") + ": " + counts;
}

void PrintReports(const Options& options, const Found& found, const Results& results,
                  const std::vector<ValidationReport>& reports) {
  if (options.json) {
    nlohmann::ordered_json json = ToJson(reports);
    json["complete"] = reports.size() == results.reports.size();
    json["missing"] = MissingToJson(found.missing);
    if (options.fix) json["fixes"] = FixesToJson(results);
    std::cout << JsonText(json, 2) << '\n';
    return;
  }
  int errors = 0;
  int warnings = 0;
  for (const FixReport& fixed : results.fixes) PrintFixes(fixed, options.dry_run);
  for (const ValidationReport& report : reports) {
    errors += report.errors;
    warnings += report.warnings;
    Print(report);
  }
  std::printf(
      "%s\n",
      Summary(reports.size(), found.missing.size(), CountedFindings(errors, warnings)).c_str());
}

void SayMissing(const Found& found) {
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

// This is what a run ends with that was not stopped.
int ExitCode(const Options& options, const Found& found, std::size_t checked, bool errors) {
  if (found.unreadable || !found.missing.empty() || checked == 0) return 3;
  if (options.expect >= 0 && checked != static_cast<std::size_t>(options.expect)) {
    std::fprintf(stderr, "doorforge: %s checked, expected %d (--expect)\n",
                 Counted(checked, "folder").c_str(), options.expect);
    return 4;
  }
  return errors ? 1 : 0;
}

int Finish(const Options& options, Found found, Results results) {
  std::vector<ValidationReport> reports;
  bool errors = false;
  for (std::size_t i = 0; i < results.reports.size(); ++i) {
    if (!results.problems[i].empty()) {
      std::fprintf(stderr, "doorforge: %s\n", results.problems[i].c_str());
      found.unreadable = true;
    }
    if (!results.reports[i]) continue;
    ExplainLeft(results.fixes[i], *results.reports[i]);
    errors = errors || results.reports[i]->errors > 0;
    reports.push_back(std::move(*results.reports[i]));
  }
  PrintReports(options, found, results, reports);
  if (StopRequested() != 0) {
    std::fprintf(stderr, "doorforge: stopped after %zu of %zu folders\n", reports.size(),
                 results.reports.size());
    return 128 + StopRequested();
  }
  SayMissing(found);
  return ExitCode(options, found, reports.size(), errors);
}

Found FindAll(const std::vector<std::string>& paths) {
  Found found;
  const auto try_to = [&](auto&& find) {
    try {
      find();
    } catch (const Error& error) {
      std::fprintf(stderr, "doorforge: %s\n", error.what());
      found.unreadable = true;
    }
  };
  for (const std::string& path : paths) {
    try_to([&] {
      for (MissingRecord& record : FindMissingRecords(path))
        found.missing.push_back(std::move(record));
    });
    try_to([&] {
      for (fs::path& folder : FindRecords(path)) found.folders.push_back(std::move(folder));
    });
  }
  return found;
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
  const Options options = Parse(argc, argv);
  if (options.rules) return ListRules(options.json);
  Found found = FindAll(options.paths);
  Results results = ValidateAll(options, found.folders);
  return Finish(options, std::move(found), std::move(results));
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/validate/validate_folders.h"

#include <exception>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// The fix report knows why --fix could not mend a fixable finding.
void ExplainLeft(const FixReport& fixed, ValidationReport& report) {
  for (Finding& finding : report.findings) {
    for (const Finding& left : fixed.left) {
      if (finding.code == left.code && finding.where == left.where) finding.fix = left.fix;
    }
  }
}

void CheckFolder(const DoorValidator& validator, const fs::path& folder, const FolderChecks& checks,
                 CheckedFolder& checked) {
  const WorkBudget budget(folder.string(), checks.max_seconds);
  if (checks.fix) {
    try {
      checked.fixes = FixFolder(folder, *checks.fix);
    } catch (const std::exception&) {
      checked.problem = CurrentProblem(folder.string());
    }
  }
  try {
    checked.report = validator.Validate(folder);
    ExplainLeft(checked.fixes, *checked.report);
  } catch (const std::exception&) {
    checked.problem = CurrentProblem(folder.string());
  }
}

nlohmann::ordered_json FixesToJson(std::span<const CheckedFolder> checked) {
  auto fixes = nlohmann::ordered_json::array();
  for (const CheckedFolder& folder : checked) {
    for (const Fix& fix : folder.fixes.fixes)
      fixes.push_back({{"folder", folder.fixes.folder.string()},
                       {"code", fix.code},
                       {"where", fix.where},
                       {"done", fix.done},
                       {"written", folder.fixes.written}});
  }
  return fixes;
}

nlohmann::ordered_json MissingToJson(std::span<const MissingRecord> missing) {
  auto json = nlohmann::ordered_json::array();
  for (const MissingRecord& record : missing)
    json.push_back({{"folder", record.folder.string()},
                    {"record", record.record},
                    {"told_by", record.told_by}});
  return json;
}

}  // namespace

RecordsFound FindAllRecords(std::span<const std::string> paths) {
  RecordsFound found;
  const auto try_to = [&](auto&& find) {
    try {
      find();
    } catch (const Error& error) {
      found.problems.emplace_back(error.what());
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

std::vector<CheckedFolder> ValidateFolders(const DoorValidator& validator,
                                           std::span<const fs::path> folders,
                                           const FolderChecks& checks) {
  std::vector<CheckedFolder> checked(folders.size());
  Progress progress("validating", folders.size());
  ParallelFor(folders.size(), checks.threads, [&](std::size_t i) {
    if (StopRequested() != 0) return;
    CheckFolder(validator, folders[i], checks, checked[i]);
    progress.Advance();
  });
  return checked;
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

nlohmann::ordered_json CheckedToJson(std::span<const CheckedFolder> checked,
                                     std::span<const MissingRecord> missing, bool fixed) {
  std::vector<ValidationReport> reports;
  for (const CheckedFolder& folder : checked) {
    if (folder.report) reports.push_back(*folder.report);
  }
  nlohmann::ordered_json json = ToJson(reports);
  json["complete"] = reports.size() == checked.size();
  json["missing"] = MissingToJson(missing);
  if (fixed) json["fixes"] = FixesToJson(checked);
  return json;
}

}  // namespace doorforge

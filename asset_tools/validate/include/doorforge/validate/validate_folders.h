// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/validate/fix_door.h"
#include "doorforge/validate/missing_records.h"
#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// What there is to check, and what there should be.
struct RecordsFound {
  std::vector<std::filesystem::path> folders;
  std::vector<MissingRecord> missing;
  /// Messages of paths that could not be read, or of what should tell of missing records.
  std::vector<std::string> problems;
};

/// The folders of doors and parts at or below each path, see FindRecords() and
/// FindMissingRecords(). Never throws on what is there.
RecordsFound FindAllRecords(std::span<const std::string> paths);

/// How folders are checked.
struct FolderChecks {
  std::optional<FixMode> fix = {};  ///< What can be mended is mended before.
  int threads = 0;                  ///< 0: all processors.
  double max_seconds = 300;         ///< Processor time that one folder may take [s].
};

/// What came of a folder. There is no report where a stop request came first.
struct CheckedFolder {
  std::optional<ValidationReport> report;
  FixReport fixes;
  std::string problem;  ///< Why it could not be checked or mended; empty if it could.
};

/// Checks each folder, in the order given, and shows progress. A finding that `fix` could not mend
/// says why in its `fix`. A folder whose record went away meanwhile costs its own report alone.
std::vector<CheckedFolder> ValidateFolders(const DoorValidator& validator,
                                           std::span<const std::filesystem::path> folders,
                                           const FolderChecks& checks);

/// {"schema": "doorforge.validation_rules", "rules": [{"code", "severity", "text", "limit",
/// "allowed", "fix", "fixable"}]}, where "limit" is null for rules without one.
nlohmann::ordered_json RulesToJson();

/// The document is that of ToJson() for the reports, with "complete" (none was stopped), "missing":
/// [{"folder", "record", "told_by"}] and, if `fixed`, "fixes": [{"folder", "code", "where", "done",
/// "written"}].
nlohmann::ordered_json CheckedToJson(std::span<const CheckedFolder> checked,
                                     std::span<const MissingRecord> missing, bool fixed);

}  // namespace doorforge

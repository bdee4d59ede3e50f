// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace doorforge {

enum class Severity {
  kError,    ///< The door must not be used.
  kWarning,  ///< It works, but not for everything.
  kInfo,
};
std::string_view NameOf(Severity severity);  ///< "error", "warning", "info".

/// One rule. Codes are never reused. Families: REC records, MSH meshes, COL collision shapes,
/// INR mass and inertia, MEC joints and latch, URD the URDF, HND handle and grasp, LIC licences.
struct ValidationRule {
  std::string_view code;
  Severity severity;
  std::string_view text;     ///< What holds when the rule is met.
  double limit;              ///< In SI units; 0 where `allowed` has none.
  std::string_view allowed;  ///< The allowed values; "{}" stands for the limit.
  std::string_view fix;      ///< What to do.
};

/// All rules, by family. docs/validation-rules.md lists the same.
std::span<const ValidationRule> ValidationRules();

/// One place where a rule is broken.
struct Finding {
  std::string code;
  Severity severity = Severity::kError;
  std::string where;     ///< File in the folder, with link or XPath.
  std::string measured;  ///< With unit.
  std::string allowed;
  std::string fix;
};

/// Which rules count.
enum class ValidationProfile {
  kUrdf,     ///< REC, MSH, INR, URD, LIC: what a simulator needs to load the door.
  kPhysics,  ///< All rules.
};

struct ValidationReport {
  std::filesystem::path folder;
  std::vector<Finding> findings;  ///< By family in the order of ValidationRules(), then by place.
  int errors = 0;
  int warnings = 0;
};

/// Checks a folder written by WriteDoorFolder() or WritePart(), or changed by hand since: reads
/// what can be read, and reports every fault that can be told from it. Deterministic; never throws
/// on what the folder holds. Throws Error(kMissing) if it has neither door.json nor part.json.
ValidationReport ValidateDoor(const std::filesystem::path& folder,
                              ValidationProfile profile = ValidationProfile::kPhysics);
ValidationReport ValidatePart(const std::filesystem::path& folder,
                              ValidationProfile profile = ValidationProfile::kPhysics);

/// ValidateDoor() or ValidatePart(), by the record that the folder holds.
ValidationReport Validate(const std::filesystem::path& folder, ValidationProfile profile);

/// Folders of doors and parts at or below `path`, sorted. Throws Error(kMissing) if there is none.
std::vector<std::filesystem::path> FindRecords(const std::filesystem::path& path);

/// {"schema": "doorforge.validation", "findings": [{"folder", "code", "severity", "where",
/// "measured", "allowed", "fix"}], "counts": {"folders", "errors", "warnings", "infos"}}.
nlohmann::ordered_json ToJson(std::span<const ValidationReport> reports);

}  // namespace doorforge

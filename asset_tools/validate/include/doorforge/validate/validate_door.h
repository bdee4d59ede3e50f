// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

enum class Severity {
  kError,    ///< The door must not be used.
  kWarning,  ///< It works, but not for everything.
  kInfo,
};
std::string_view NameOf(Severity severity);  ///< "error", "warning", "info".

/// One rule. Codes are never reused. Families: REC records, MSH meshes, COL collision shapes,
/// INR mass and inertia, MEC joints and latch, URD the URDF, HND handle and grasp, SWP the moving
/// leaf, OPN the simulated opening, LIC licences.
struct ValidationRule {
  std::string_view code;
  Severity severity;
  std::string_view text;     ///< What holds when the rule is met.
  double limit;              ///< In SI units; 0 where `allowed` has none.
  std::string_view allowed;  ///< The allowed values; "{}" stands for the limit.
  std::string_view fix;      ///< What to do.
  bool fixable = false;      ///< FixFolder() can do it, see fix_door.h.
};

/// All rules, by family. docs/validation-rules.md lists the same.
std::span<const ValidationRule> ValidationRules();

/// A rule's `allowed` with its limit in place.
std::string AllowedText(const ValidationRule& rule);

/// Where a finding about a file from outside lies, and its measure as numbers.
struct FindingPlace {
  std::string file;
  int line = 0;         ///< From 1; 0 where the format has no lines.
  int column = 0;       ///< From 1, in bytes; 0 likewise.
  std::string element;  ///< XPath, prim path or JSON pointer.
  std::optional<double> value;
  std::optional<double> limit;
  std::string unit;
};

/// One place where a rule is broken.
struct Finding {
  std::string code;
  Severity severity = Severity::kError;
  std::string where;     ///< File in the folder, with link or XPath.
  std::string measured;  ///< With unit.
  std::string allowed;
  std::string fix;
  bool fixable = false;
  FindingPlace place = {};  ///< Empty where `where` says all.
};

/// A finding of a rule: severity, allowed and fix are the rule's. For the checks that a program
/// hands in. Both throw Error(kInvalidArgument) on an unknown code.
Finding FindingOf(std::string_view code, const std::string& where, const std::string& measured);
double RuleLimit(std::string_view code);

/// Which rules count.
enum class ValidationProfile {
  kUrdf,      ///< REC, MSH, INR, URD, LIC: what a simulator needs to load the door.
  kPhysics,   ///< All rules but SWP and OPN.
  kOpenable,  ///< All rules.
};
inline constexpr NamedValue<ValidationProfile> kValidationProfiles[] = {
    {ValidationProfile::kUrdf, "urdf"},
    {ValidationProfile::kPhysics, "physics"},
    {ValidationProfile::kOpenable, "openable"}};
constexpr std::span<const NamedValue<ValidationProfile>> ValuesOf(ValidationProfile) {
  return kValidationProfiles;
}

/// SWP and OPN: what a simulation of the door finds. This room may not simulate, so the program
/// that can hands the check in. It must be a pure function and bear several threads.
using OpeningCheck = std::function<std::vector<Finding>(const DoorAsset&)>;

/// What was judged: a record of doorforge, or a file from outside by its format.
enum class ValidatedKind { kDoor, kPart, kUrdf, kMjcf, kSdf, kUsda, kGltf, kMesh, kUnknown };
inline constexpr NamedValue<ValidatedKind> kValidatedKinds[] = {
    {ValidatedKind::kDoor, "door"},      {ValidatedKind::kPart, "part"},
    {ValidatedKind::kUrdf, "urdf"},      {ValidatedKind::kMjcf, "mjcf"},
    {ValidatedKind::kSdf, "sdf"},        {ValidatedKind::kUsda, "usda"},
    {ValidatedKind::kGltf, "gltf"},      {ValidatedKind::kMesh, "mesh"},
    {ValidatedKind::kUnknown, "unknown"}};
constexpr std::span<const NamedValue<ValidatedKind>> ValuesOf(ValidatedKind) {
  return kValidatedKinds;
}

struct ValidationReport {
  std::filesystem::path folder;
  std::vector<Finding> findings;  ///< Families are in the order of ValidationRules(), then places.
  int errors = 0;
  int warnings = 0;
  ValidatedKind kind = ValidatedKind::kDoor;
  std::vector<std::string> notes = {};  ///< What was assumed and what was not asked.
};

/// Checks folders written by WriteDoorFolder(), WriteSharedDoors() or WritePart(), or changed by
/// hand since: reads what can be read, and reports every fault that can be told from it.
///
/// What many doors have in common is read and measured once: a mesh of a pool, a piece with its
/// convex pieces, a leaf. It is remembered by content, so that a report does not depend on the
/// folders before it, nor on how many threads share a validator. Files of a pool that change while
/// it lives may go unnoticed; take a new one then.
class DoorValidator {
 public:
  explicit DoorValidator(ValidationProfile profile = ValidationProfile::kPhysics);
  /// Profile kOpenable. Doors with errors are not simulated: OPN007 says so.
  explicit DoorValidator(OpeningCheck check);
  ~DoorValidator();
  DoorValidator(const DoorValidator&) = delete;
  DoorValidator& operator=(const DoorValidator&) = delete;

  /// The record that the folder holds decides what is checked. Deterministic; never throws on what
  /// the folder holds: a check that takes too much time (see work_budget.h) or memory is finding
  /// REC003. Throws Error(kMissing) if it has neither door.json nor part.json. May be called from
  /// several threads at once.
  ValidationReport Validate(const std::filesystem::path& folder) const;
  /// These do the same where the kind is known, and throw Error(kMissing) if its record is missing.
  ValidationReport Door(const std::filesystem::path& folder) const;
  ValidationReport Part(const std::filesystem::path& folder) const;

 private:
  struct Memory;

  ValidationProfile profile_;
  OpeningCheck opening_check_;
  std::unique_ptr<Memory> memory_;
};

/// One folder, with a validator of its own.
ValidationReport ValidateDoor(const std::filesystem::path& folder,
                              ValidationProfile profile = ValidationProfile::kPhysics);
ValidationReport ValidatePart(const std::filesystem::path& folder,
                              ValidationProfile profile = ValidationProfile::kPhysics);

/// Folders of doors and parts at or below `path`, sorted; those whose name begins with a dot are
/// left out: what a killed program left. Throws Error(kMissing) if there is none.
std::vector<std::filesystem::path> FindRecords(const std::filesystem::path& path);
/// Those of all paths, path by path.
std::vector<std::filesystem::path> FindRecords(const std::vector<std::string>& paths);

/// {"schema": "doorforge.validation", "findings": [{"folder", "code", "severity", "where",
/// "measured", "allowed", "fix", "fixable"}], "counts": {"folders", "errors", "warnings",
/// "infos"}}.
nlohmann::ordered_json ToJson(std::span<const ValidationReport> reports);

}  // namespace doorforge

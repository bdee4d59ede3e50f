// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/named_enum.h"
#include "doorforge/foreign/validate_foreign.h"
#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// From which severity on a finding makes a run fail.
enum class FailOn { kError, kWarning, kNever };
inline constexpr NamedValue<FailOn> kFailOnWords[] = {
    {FailOn::kError, "error"}, {FailOn::kWarning, "warning"}, {FailOn::kNever, "never"}};
constexpr std::span<const NamedValue<FailOn>> ValuesOf(FailOn) { return kFailOnWords; }

/// What a project says about its validation, as `.doorforge-validate.yaml` holds it.
struct ValidationSettings {
  FailOn fail_on = FailOn::kError;
  std::vector<std::string> ignore;    ///< Codes, or families such as "HND".
  std::vector<std::string> severity;  ///< "CODE=error", "CODE=warning" or "CODE=info".
  std::vector<std::string> exclude;   ///< Files and folders, from where the settings lie.
  std::string baseline;               ///< File of findings that are known, from there.
  std::string root;                   ///< ForeignChecks::root, from there.
  std::vector<std::string> packages;  ///< "NAME=FOLDER", from there.
  std::string hinge;
  std::string handle;
  std::vector<std::string> ask = ForeignChecks{}.ask;
  TargetProfile target = TargetProfile::kNone;  ///< Files from outside are for it.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("fail_on", self.fail_on);
    visit("ignore", self.ignore);
    visit("severity", self.severity);
    visit("exclude", self.exclude);
    visit("baseline", self.baseline);
    visit("root", self.root);
    visit("packages", self.packages);
    visit("hinge", self.hinge);
    visit("handle", self.handle);
    visit("ask", self.ask);
    visit("target", self.target);
  }
};

/// The file `.doorforge-validate.yaml` in the folder of `path` or the nearest one above; empty if
/// there is none.
std::filesystem::path FindValidationSettings(const std::filesystem::path& path);

/// Settings of a file, with its paths made absolute. Throws Error(kInvalidConfig) that names what
/// is wrong: a key, a word, or a code that there is not.
ValidationSettings ReadValidationSettings(const std::filesystem::path& file);

/// Those of `config`, or where it is empty of the file that FindValidationSettings() finds for
/// `path`, with what was given beside: lists are added to, "none" in `ask` empties it, other values
/// that are not empty replace. Throws as ReadValidationSettings() and RequireValid().
ValidationSettings SettingsFor(const std::string& config, const std::filesystem::path& path,
                               const ValidationSettings& given);

/// Throws Error(kInvalidConfig) on a code, severity, package or program that there is not.
void RequireValid(const ValidationSettings& settings);

/// How files from outside are checked by these settings.
ForeignChecks ChecksOf(const ValidationSettings& settings);

/// Findings that are known and count no more: code, file and element of each, without its line.
class Baseline {
 public:
  Baseline() = default;
  /// Throws Error(kMissing, kIo or kFormat).
  explicit Baseline(const std::filesystem::path& file);

  /// Takes away what is known, as often as it is; returns how many findings went.
  std::size_t TakeFrom(ValidationReport& report);

  /// A document of all findings of these reports: {"schema": "doorforge.validation_baseline",
  /// "findings": [{"path", "code", "where"}]}.
  static nlohmann::ordered_json Of(std::span<const ValidationReport> reports);

 private:
  std::vector<std::string> known_;  // sorted
};

/// Changes severities, takes away what is ignored, and counts anew.
void ApplySettings(const ValidationSettings& settings, ValidationReport& report);

/// Whether the report makes a run fail.
bool Fails(const ValidationReport& report, FailOn fail_on);
/// Whether a finding of this severity does.
bool Fails(Severity severity, FailOn fail_on);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/foreign/validation_settings.h"
#include "doorforge/validate/validate_door.h"

// Reports for programs that others run. Each is a pure function of the reports.

namespace doorforge {

/// Where a finding lies in terms of files: its place, or for a door or part the file of its folder
/// that `where` names.
FindingPlace PlaceOf(const ValidationReport& report, const Finding& finding);

/// "HND003 error: measured 0.02 m; allowed at most 0.01 m; to fix: ...".
std::string SentenceOf(const Finding& finding);

/// SARIF 2.1.0 (OASIS): one run; the rules that were broken, with their help; a result a finding,
/// at most 25,000 as GitHub takes them, with the rest as a notification; fingerprints without
/// lines.
nlohmann::ordered_json ToSarif(std::span<const ValidationReport> reports);

/// JUnit's XML: a test case an item, with those that passed; only findings at or above `fail_on`
/// are failures, the others are its output.
std::string ToJunit(std::span<const ValidationReport> reports, FailOn fail_on);

/// Workflow commands of GitHub, a line a finding: ::error file=,line=,col=,title=::.
std::string ToGithub(std::span<const ValidationReport> reports);

/// One page of HTML without scripts and requests: every item, passed ones too, and its findings.
std::string ToHtml(std::span<const ValidationReport> reports);

/// [{"path", "kind", "status", "errors", "warnings", "notes", "findings"}], where the status is
/// "passed" or "failed", and a finding has the keys of ToJson() in validate_door.h and "file",
/// "line", "column", "element", "value", "limit", "unit", "help_uri" where they are known.
nlohmann::ordered_json ItemsToJson(std::span<const ValidationReport> reports, FailOn fail_on);

}  // namespace doorforge

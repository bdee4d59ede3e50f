// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/foreign/validation_settings.h"
#include "doorforge/validate/validate_folders.h"

namespace doorforge {

enum class FindingFormat { kText, kJson, kSarif, kJunit, kGithub, kHtml };
inline constexpr NamedValue<FindingFormat> kFindingFormats[] = {
    {FindingFormat::kText, "text"},     {FindingFormat::kJson, "json"},
    {FindingFormat::kSarif, "sarif"},   {FindingFormat::kJunit, "junit"},
    {FindingFormat::kGithub, "github"}, {FindingFormat::kHtml, "html"}};
constexpr std::span<const NamedValue<FindingFormat>> ValuesOf(FindingFormat) {
  return kFindingFormats;
}

/// A report with the folder in which its file was found, as ForeignValidator::Validate() takes it.
struct ReportedItem {
  ValidationReport report;
  std::filesystem::path searched;  ///< Empty for doors, parts, and files that were named.
};

/// Makes a page of HTML that draws the findings on what they are about. This room draws nothing, so
/// the program that can hands it in.
using FindingsPage = std::function<std::string(std::span<const ReportedItem>)>;

/// What `doorforge validate` is asked for.
struct ValidationRequest {
  std::vector<std::string> paths;
  FolderChecks checks;
  ValidationSettings settings;
  FindingFormat format = FindingFormat::kText;
  int expect = -1;                     ///< How many items there should be; -1: any number.
  std::filesystem::path new_baseline;  ///< Where the findings are written; empty: nowhere.
  FindingsPage page;                   ///< Of kHtml; empty: ToHtml(), which draws nothing.
};

struct ValidationAnswer {
  std::string document;  ///< In the format asked for, with its line end.
  std::string messages;  ///< For people, a line each with its line end.
  int exit_code = 0;
};

/// Finds doors, parts and files from outside at the paths, checks them, and says what came of it.
/// Folders with doors or parts are judged by these alone; a message tells of files of other
/// formats there. door.json and part.json stand for their folders. Shows progress. The exit code
/// is 0, 1 where a report fails by the settings, 3 where something could not be read, a record is
/// missing or nothing was found, 4 where `expect` is another number, 128 + the signal that stopped
/// it. Throws as Baseline() and CommitFile().
ValidationAnswer RunValidation(const DoorValidator& validator, const ValidationRequest& request);

/// What one word for a profile stands for.
struct ChosenProfile {
  ValidationProfile doors = ValidationProfile::kPhysics;
  TargetProfile target = TargetProfile::kNone;  ///< Of files from outside.
};
/// "urdf", "physics", "openable" of doors, then "mujoco", "isaac", "gazebo", "sapien" of files.
std::vector<std::string> ProfileWords();
/// Empty: the defaults. Throws Error(kInvalidArgument) on another word.
ChosenProfile ProfileNamed(const std::string& word);

/// The rules of doors and for files from outside, as RulesToJson() has them.
nlohmann::ordered_json AllRulesToJson();
/// A line each.
std::string AllRulesText();

}  // namespace doorforge

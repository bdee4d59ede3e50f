// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/foreign/validation_run.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/foreign/finding_formats.h"
#include "doorforge/foreign/foreign_rules.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string CountOf(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string CountsOf(std::size_t errors, std::size_t warnings) {
  return CountOf(errors, "error") + ", " + CountOf(warnings, "warning");
}

// Names of files may hold what a terminal obeys.
std::string Shown(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return text;
}

/// What lies at the paths.
struct Found {
  RecordsFound records;
  std::vector<std::pair<fs::path, fs::path>> files;  // with the folder that was searched
  std::vector<std::string> passed_over;              // messages
};

bool IsBelow(const fs::path& path, const fs::path& folder) {
  const fs::path relative = fs::absolute(path).lexically_normal().lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

bool IsExcluded(const fs::path& path, const ValidationSettings& settings) {
  return std::any_of(settings.exclude.begin(), settings.exclude.end(),
                     [&](const std::string& folder) { return IsBelow(path, folder); });
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

void AddFiles(const fs::path& path, const ValidationSettings& settings, Found& found) {
  for (const fs::path& file : FindForeignFiles(path)) {
    if (!IsExcluded(file, settings))
      found.files.emplace_back(file, IsFolder(path) ? path : fs::path());
  }
}

void AddFolder(const std::string& path, const ValidationSettings& settings, Found& found) {
  RecordsFound one = FindAllRecords(std::array{path});
  if (one.folders.empty() && one.missing.empty() && IsFolder(path)) {
    const std::size_t before = found.files.size();
    AddFiles(path, settings, found);
    if (found.files.size() > before) return;
  } else if (!one.folders.empty() && one.folders.front() != fs::path(path)) {
    const std::vector<fs::path> others = FindForeignFiles(path);
    const auto objects = std::count_if(others.begin(), others.end(), [](const fs::path& file) {
      const std::string ending = file.extension().string();
      return ending == ".urdf" || ending == ".sdf" || ending == ".usda" || ending == ".xml";
    });
    if (objects > 0)
      found.passed_over.push_back(path + ": beside doors and parts it holds " +
                                  CountOf(static_cast<std::size_t>(objects), "file") +
                                  " of other formats, which are not looked at; name them, or their "
                                  "folder");
  }
  for (fs::path& folder : one.folders) {
    if (!IsExcluded(folder, settings)) found.records.folders.push_back(std::move(folder));
  }
  const auto move = [](auto& from, auto& to) {
    for (auto& entry : from) to.push_back(std::move(entry));
  };
  move(one.missing, found.records.missing);
  move(one.problems, found.records.problems);
}

Found FindAll(const ValidationRequest& request) {
  Found found;
  for (const std::string& path : request.paths) {
    try {
      const fs::path at(path);
      const bool record = at.filename() == "door.json" || at.filename() == "part.json";
      const fs::path parent = at.has_parent_path() ? at.parent_path() : fs::path(".");
      if (record && IsFile(at))
        AddFolder(parent.string(), request.settings, found);
      else if (IsFile(at))
        AddFiles(at, request.settings, found);
      else if (std::error_code error; !fs::exists(at, error) && at.has_extension())
        found.records.problems.push_back(path + ": no such file or folder, no such folder");
      else
        AddFolder(path, request.settings, found);
    } catch (const std::exception& error) {
      found.records.problems.emplace_back(error.what());
    }
  }
  return found;
}

std::vector<std::optional<ValidationReport>> CheckFiles(
    const ValidationRequest& request, const std::vector<std::pair<fs::path, fs::path>>& files) {
  std::vector<std::optional<ValidationReport>> reports(files.size());
  if (files.empty()) return reports;
  const ForeignValidator validator(ChecksOf(request.settings));
  Progress progress("validating", files.size());
  ParallelFor(files.size(), request.checks.threads, [&](std::size_t i) {
    if (StopRequested() != 0) return;
    const auto& [file, searched] = files[i];
    const WorkBudget budget(file.string(), request.checks.max_seconds);
    reports[i] = validator.Validate(file, searched);
    progress.Advance();
  });
  return reports;
}

/// The run's reports, with what they are made into.
class Run {
 public:
  Run(const DoorValidator& validator, const ValidationRequest& request)
      : request_(request), found_(FindAll(request)) {
    Baseline known;
    if (!request.settings.baseline.empty()) known = Baseline(request.settings.baseline);
    if (!found_.records.folders.empty() || found_.files.empty())
      checked_ = ValidateFolders(validator, found_.records.folders, request.checks);
    auto files = CheckFiles(request, found_.files);
    for (CheckedFolder& folder : checked_) {
      if (folder.report) Take(*folder.report, {}, known);
    }
    folders_ = reports_.size();
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (files[i]) Take(*files[i], found_.files[i].second, known);
    }
  }

  ValidationAnswer Answer() {
    ValidationAnswer answer;
    if (!request_.new_baseline.empty())
      CommitFile(request_.new_baseline, JsonText(Baseline::Of(reports_), 2) + "\n");
    answer.document = Document();
    answer.exit_code = ExitCode();
    answer.messages = std::move(messages_);
    return answer;
  }

 private:
  void Take(ValidationReport& report, const fs::path& searched, Baseline& known) {
    ApplySettings(request_.settings, report);
    known_ += known.TakeFrom(report);
    ApplySettings({}, report);
    reports_.push_back(report);
    searched_.push_back(searched);
  }

  std::string Document() const {
    switch (request_.format) {
      case FindingFormat::kJson:
        return JsonText(AsJson(), 2) + "\n";
      case FindingFormat::kSarif:
        return JsonText(ToSarif(reports_), 2) + "\n";
      case FindingFormat::kJunit:
        return ToJunit(reports_, request_.settings.fail_on);
      case FindingFormat::kGithub:
        return ToGithub(reports_);
      case FindingFormat::kHtml:
        return AsPage();
      default:
        return AsText();
    }
  }

  std::string AsPage() const {
    if (!request_.page) return ToHtml(reports_);
    std::vector<ReportedItem> items;
    for (std::size_t i = 0; i < reports_.size(); ++i) items.push_back({reports_[i], searched_[i]});
    return request_.page(items);
  }

  Json AsJson() const {
    std::vector<CheckedFolder> checked = checked_;
    std::size_t at = 0;
    for (CheckedFolder& folder : checked) {
      if (folder.report) folder.report = reports_[at++];
    }
    // files count as folders of one file, so that one document has all findings
    for (; at < reports_.size(); ++at) checked.push_back({reports_[at], {}, {}});
    Json json = CheckedToJson(checked, found_.records.missing, request_.checks.fix.has_value());
    json["complete"] = reports_.size() == checked_.size() + found_.files.size();
    json["baseline"] = known_;
    json["items"] = ItemsToJson(reports_, request_.settings.fail_on);
    return json;
  }

  static std::string TextOf(const Finding& finding) {
    return "  " + finding.code + " " + std::string(NameOf(finding.severity)) +
           std::string(8 - NameOf(finding.severity).size(), ' ') + finding.where +
           "\n    measured " + finding.measured + "; allowed " + finding.allowed +
           "; to fix: " + finding.fix + "\n";
  }

  static std::string TextOf(const ValidationReport& report, bool is_file) {
    if (report.findings.empty() && !is_file) return {};
    std::string text = Shown(report.folder.string()) + ": ";
    text += report.findings.empty() ? std::string(NameOf(report.kind)) + ", passed\n"
                                    : CountsOf(static_cast<std::size_t>(report.errors),
                                               static_cast<std::size_t>(report.warnings)) +
                                          "\n";
    for (const Finding& finding : report.findings) text += TextOf(finding);
    for (const std::string& note : report.notes) text += "  note: " + note + "\n";
    return text;
  }

  std::string AsText() const {
    std::string text;
    for (const CheckedFolder& folder : checked_) {
      for (const Fix& fix : folder.fixes.fixes)
        text += Shown(folder.fixes.folder.string()) +
                (request_.checks.fix == FixMode::kDryRun ? ": would fix " : ": fixed ") + fix.code +
                ": " + fix.where + ": " + fix.done + "\n";
    }
    std::size_t errors = 0;
    std::size_t warnings = 0;
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      errors += static_cast<std::size_t>(reports_[i].errors);
      warnings += static_cast<std::size_t>(reports_[i].warnings);
      text += TextOf(reports_[i], i >= folders_);
    }
    return text + Summary(errors, warnings) + "\n";
  }

  std::string Summary(std::size_t errors, std::size_t warnings) const {
    const std::size_t missing = found_.records.missing.size();
    if (reports_.empty())
      return "nothing checked" +
             (missing == 0 ? "" : ": " + CountOf(missing, "record") + " missing");
    const std::size_t files = reports_.size() - folders_;
    std::string text = folders_ > 0 || files == 0 ? CountOf(folders_, "folder") : "";
    if (files > 0) text += (text.empty() ? "" : ", ") + CountOf(files, "file");
    if (missing > 0) text += ", " + std::to_string(missing) + " missing";
    text += ": " + CountsOf(errors, warnings);
    return known_ == 0 ? text
                       : text + "; " + CountOf(known_, "finding") + " of the baseline left out";
  }

  void Say(const std::string& message) { messages_ += "doorforge: " + Shown(message) + "\n"; }

  int ExitCode() {
    for (const std::string& problem : found_.records.problems) Say(problem);
    for (const std::string& message : found_.passed_over) Say(message);
    bool unreadable = !found_.records.problems.empty();
    for (const CheckedFolder& folder : checked_) {
      if (folder.problem.empty()) continue;
      Say(folder.problem);
      unreadable = true;
    }
    if (StopRequested() != 0) {
      Say("stopped after " + std::to_string(reports_.size()) + " of " +
          std::to_string(checked_.size() + found_.files.size()) + " items");
      return 128 + StopRequested();
    }
    SayMissing();
    if (unreadable || !found_.records.missing.empty() || reports_.empty()) return 3;
    if (request_.expect >= 0 && reports_.size() != static_cast<std::size_t>(request_.expect)) {
      const bool files = folders_ < reports_.size();
      Say(CountOf(reports_.size(), files ? "item" : "folder") + " checked, expected " +
          std::to_string(request_.expect) + " (--expect)");
      return 4;
    }
    const FailOn fail_on = request_.settings.fail_on;
    return std::any_of(reports_.begin(), reports_.end(),
                       [&](const ValidationReport& report) { return Fails(report, fail_on); })
               ? 1
               : 0;
  }

  void SayMissing() {
    for (const MissingRecord& record : found_.records.missing)
      Say(record.folder.string() + ": " + record.record + " is missing, and " + record.told_by +
          " says that it was there; compose or import it again, or take away what names it");
    if (reports_.empty() && found_.records.missing.empty())
      Say("nothing checked: give the folder of a door or part, or one that holds some, as "
          "`doorforge compose` and `doorforge import` write them, or files of URDF, MJCF, SDF, "
          "USDA, "
          "glTF or meshes");
  }

  const ValidationRequest& request_;
  Found found_;
  std::vector<CheckedFolder> checked_;
  std::vector<ValidationReport> reports_;
  std::vector<fs::path> searched_;  // by report
  std::size_t folders_ = 0;         // of the reports, the first ones
  std::size_t known_ = 0;
  std::string messages_;
};

Json RuleJson(const ValidationRule& rule) {
  Json entry = {{"code", rule.code},       {"severity", NameOf(rule.severity)}, {"text", rule.text},
                {"limit", nullptr},        {"allowed", AllowedText(rule)},      {"fix", rule.fix},
                {"fixable", rule.fixable}, {"help_uri", RuleHelpUri(rule.code)}};
  if (rule.allowed.find("{}") != std::string_view::npos) entry["limit"] = rule.limit;
  return entry;
}

}  // namespace

ValidationAnswer RunValidation(const DoorValidator& validator, const ValidationRequest& request) {
  return Run(validator, request).Answer();
}

std::vector<std::string> ProfileWords() {
  std::vector<std::string> words = NamesOf<ValidationProfile>();
  for (const std::string& target : NamesOf<TargetProfile>()) {
    if (target != NameOf(TargetProfile::kNone)) words.push_back(target);
  }
  return words;
}

ChosenProfile ProfileNamed(const std::string& word) {
  ChosenProfile chosen;
  if (word.empty()) return chosen;
  const auto doors = ValueNamed<ValidationProfile>(word);
  const auto target = ValueNamed<TargetProfile>(word);
  if (!doors && (!target || *target == TargetProfile::kNone))
    throw Error(ErrorCode::kInvalidArgument, "no profile \"" + word + '"');
  chosen.doors = doors.value_or(chosen.doors);
  chosen.target = target.value_or(chosen.target);
  return chosen;
}

Json AllRulesToJson() {
  Json json = RulesToJson();
  json["rules"] = Json::array();
  for (const ValidationRule& rule : AllRules()) json["rules"].push_back(RuleJson(rule));
  return json;
}

std::string AllRulesText() {
  std::string text;
  for (const ValidationRule& rule : AllRules()) {
    std::string line = std::string(rule.code) + " " + std::string(NameOf(rule.severity));
    line.resize(15, ' ');
    line += rule.fixable ? "fixable " : "        ";
    text += line + std::string(rule.text) + "\n";
  }
  return text;
}

}  // namespace doorforge

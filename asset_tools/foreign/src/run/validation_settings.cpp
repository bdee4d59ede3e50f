// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/foreign/validation_settings.h"

#include <algorithm>
#include <array>

#include "doorforge/core/config_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/foreign/foreign_rules.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSettingsFile = ".doorforge-validate.yaml";
constexpr const char* kBaselineSchema = "doorforge.validation_baseline";

std::pair<std::string, std::string> SplitAtEquals(const std::string& text,
                                                  const std::string& what) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0 || at + 1 == text.size())
    throw Error(ErrorCode::kInvalidConfig, what + " \"" + text + "\": expected NAME=VALUE");
  return {text.substr(0, at), text.substr(at + 1)};
}

Severity SeverityNamed(const std::string& word, const std::string& entry) {
  for (const Severity severity : {Severity::kError, Severity::kWarning, Severity::kInfo}) {
    if (word == NameOf(severity)) return severity;
  }
  throw Error(ErrorCode::kInvalidConfig,
              "severity \"" + entry + "\": expected error, warning or info after the =");
}

bool IsFamily(const std::string& code) {
  return code.size() == 3 &&
         std::any_of(AllRules().begin(), AllRules().end(),
                     [&](const ValidationRule& rule) { return rule.code.starts_with(code); });
}

void RequireCode(const std::string& code) {
  if (IsFamily(code)) return;
  try {
    AnyRule(code);
  } catch (const Error& error) {
    throw Error(ErrorCode::kInvalidConfig, error.what());
  }
}

// A finding's place without its line, which moves with every edit.
std::string WhereWithoutLine(const Finding& finding) {
  return finding.place.element.empty() && finding.place.line == 0 && finding.place.file.empty()
             ? finding.where
             : finding.place.element;
}

std::string KeyOf(const std::string& path, const std::string& code, const std::string& where) {
  return path + '\n' + code + '\n' + where;
}

}  // namespace

fs::path FindValidationSettings(const fs::path& path) {
  std::error_code error;
  fs::path at = fs::absolute(path, error).lexically_normal();
  if (!fs::is_directory(at, error)) at = at.parent_path();
  for (;; at = at.parent_path()) {
    if (fs::is_regular_file(at / kSettingsFile, error)) return at / kSettingsFile;
    if (!at.has_relative_path()) return {};
  }
}

ValidationSettings ReadValidationSettings(const fs::path& file) {
  ValidationSettings settings = LoadConfig<ValidationSettings>(file.string(), {});
  const fs::path folder = fs::absolute(file).parent_path();
  const auto absolute = [&](std::string& path) {
    if (!path.empty()) path = (folder / path).lexically_normal().string();
  };
  NamingConfig(file.string(), [&] {
    RequireValid(settings);
    return 0;
  });
  absolute(settings.baseline);
  absolute(settings.root);
  for (std::string& path : settings.exclude) absolute(path);
  for (std::string& entry : settings.packages) {
    auto [name, path] = SplitAtEquals(entry, "packages");
    absolute(path);
    entry = name + "=" + path;
  }
  return settings;
}

ValidationSettings SettingsFor(const std::string& config, const fs::path& path,
                               const ValidationSettings& given) {
  const fs::path file = config.empty() ? FindValidationSettings(path) : fs::path(config);
  ValidationSettings settings;
  if (!file.empty()) settings = ReadValidationSettings(file);
  const auto add = [](const std::vector<std::string>& more, std::vector<std::string>& list) {
    list.insert(list.end(), more.begin(), more.end());
  };
  add(given.ignore, settings.ignore);
  add(given.severity, settings.severity);
  add(given.packages, settings.packages);
  const auto replace = [](const std::string& value, std::string& old) {
    if (!value.empty()) old = value;
  };
  replace(given.baseline, settings.baseline);
  replace(given.root, settings.root);
  replace(given.hinge, settings.hinge);
  replace(given.handle, settings.handle);
  if (!given.ask.empty()) settings.ask = given.ask;
  if (given.target != TargetProfile::kNone) settings.target = given.target;
  std::erase(settings.ask, "none");
  RequireValid(settings);
  return settings;
}

void RequireValid(const ValidationSettings& settings) {
  for (const std::string& code : settings.ignore) RequireCode(code);
  for (const std::string& entry : settings.severity) {
    const auto [code, word] = SplitAtEquals(entry, "severity");
    RequireCode(code);
    SeverityNamed(word, entry);
  }
  for (const std::string& entry : settings.packages) SplitAtEquals(entry, "packages");
  for (const std::string& program : settings.ask) {
    const std::vector<std::string> all = ForeignChecks{}.ask;
    const bool known = std::find(all.begin(), all.end(), program) != all.end();
    if (!known)
      throw Error(ErrorCode::kInvalidConfig,
                  "ask \"" + program + "\": expected urdfdom, mujoco, sdformat or assimp");
  }
}

ForeignChecks ChecksOf(const ValidationSettings& settings) {
  ForeignChecks checks;
  checks.root = settings.root;
  for (const std::string& entry : settings.packages) {
    const auto [name, path] = SplitAtEquals(entry, "packages");
    checks.packages[name] = fs::absolute(path).lexically_normal();
  }
  checks.hinge = settings.hinge;
  checks.handle = settings.handle;
  checks.ask = settings.ask;
  checks.target = settings.target;
  return checks;
}

Baseline::Baseline(const fs::path& file) {
  const nlohmann::ordered_json json = ReadJsonFile(file);
  RequireSchema(json, kBaselineSchema, 1, file.string());
  for (const auto& finding : MemberOf(json, "findings", file.string())) {
    const auto text = [&](const char* key) {
      return ValueOf<std::string>(finding, key, file.string());
    };
    known_.push_back(KeyOf(text("path"), text("code"), text("where")));
  }
  std::sort(known_.begin(), known_.end());
}

std::size_t Baseline::TakeFrom(ValidationReport& report) {
  return std::erase_if(report.findings, [&](const Finding& finding) {
    const std::string key =
        KeyOf(report.folder.generic_string(), finding.code, WhereWithoutLine(finding));
    const auto found = std::lower_bound(known_.begin(), known_.end(), key);
    if (found == known_.end() || *found != key) return false;
    known_.erase(found);
    return true;
  });
}

nlohmann::ordered_json Baseline::Of(std::span<const ValidationReport> reports) {
  auto findings = nlohmann::ordered_json::array();
  for (const ValidationReport& report : reports) {
    for (const Finding& finding : report.findings)
      findings.push_back({{"path", report.folder.generic_string()},
                          {"code", finding.code},
                          {"where", WhereWithoutLine(finding)}});
  }
  return {{"schema", kBaselineSchema}, {"schema_version", 1}, {"findings", findings}};
}

void ApplySettings(const ValidationSettings& settings, ValidationReport& report) {
  std::erase_if(report.findings, [&](const Finding& finding) {
    return std::any_of(settings.ignore.begin(), settings.ignore.end(),
                       [&](const std::string& code) { return finding.code.starts_with(code); });
  });
  for (Finding& finding : report.findings) {
    for (const std::string& entry : settings.severity) {
      const auto [code, word] = SplitAtEquals(entry, "severity");
      if (finding.code.starts_with(code)) finding.severity = SeverityNamed(word, entry);
    }
  }
  report.errors = report.warnings = 0;
  for (const Finding& finding : report.findings) {
    report.errors += finding.severity == Severity::kError;
    report.warnings += finding.severity == Severity::kWarning;
  }
}

bool Fails(Severity severity, FailOn fail_on) {
  if (fail_on == FailOn::kNever || severity == Severity::kInfo) return false;
  return severity == Severity::kError || fail_on == FailOn::kWarning;
}

bool Fails(const ValidationReport& report, FailOn fail_on) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const Finding& finding) { return Fails(finding.severity, fail_on); });
}

}  // namespace doorforge

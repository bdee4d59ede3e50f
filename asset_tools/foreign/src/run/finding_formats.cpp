// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/foreign/finding_formats.h"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "doorforge/core/hash.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/page_style.h"
#include "doorforge/core/program.h"
#include "doorforge/foreign/foreign_rules.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostSarifResults = 25'000;

// RFC 3986: what is no letter, digit or one of -._~/ becomes its code.
std::string UriOf(const std::string& path) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string uri = path.starts_with('/') ? "file://" : "";
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    if (plain) {
      uri += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    uri += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return uri;
}

std::string WithoutDot(std::string path) {
  while (path.starts_with("./")) path = path.substr(2);
  return path;
}

const char* SarifLevel(Severity severity) {
  return severity == Severity::kError     ? "error"
         : severity == Severity::kWarning ? "warning"
                                          : "note";
}

Json SarifRule(const ValidationRule& rule) {
  return {
      {"id", rule.code},
      {"shortDescription", {{"text", rule.text}}},
      {"help", {{"text", "Allowed: " + AllowedText(rule) + ". To fix: " + std::string(rule.fix)}}},
      {"defaultConfiguration", {{"level", SarifLevel(rule.severity)}}},
      {"properties", {{"page", RuleHelpUri(rule.code)}}}};
}

Json SarifResult(const ValidationReport& report, const Finding& finding, std::size_t rule) {
  const FindingPlace place = PlaceOf(report, finding);
  const std::string file = WithoutDot(place.file);
  Json physical = {{"artifactLocation", {{"uri", UriOf(file)}}}};
  if (place.line > 0) {
    physical["region"] = {{"startLine", place.line}};
    if (place.column > 0) physical["region"]["startColumn"] = place.column;
  }
  Json location = {{"physicalLocation", physical}};
  const std::string& element = place.element.empty() ? finding.where : place.element;
  location["logicalLocations"] = {{{"fullyQualifiedName", element}}};
  return {{"ruleId", finding.code},
          {"ruleIndex", rule},
          {"level", SarifLevel(finding.severity)},
          {"message", {{"text", SentenceOf(finding)}}},
          {"locations", {location}},
          {"partialFingerprints",
           {{"codeAndElement/v1", Sha256Hex(finding.code + '\n' + file + '\n' + element)}}}};
}

Json FindingJson(const ValidationReport& report, const Finding& finding) {
  const FindingPlace place = PlaceOf(report, finding);
  Json json = {{"code", finding.code},       {"severity", NameOf(finding.severity)},
               {"where", finding.where},     {"measured", finding.measured},
               {"allowed", finding.allowed}, {"fix", finding.fix},
               {"fixable", finding.fixable}, {"file", place.file}};
  if (place.line > 0) json["line"] = place.line;
  if (place.column > 0) json["column"] = place.column;
  if (!place.element.empty()) json["element"] = place.element;
  if (place.value) json["value"] = *place.value;
  if (place.limit) json["limit"] = *place.limit;
  if (!place.unit.empty()) json["unit"] = place.unit;
  json["help_uri"] = RuleHelpUri(finding.code);
  return json;
}

// What XML 1.0 has no character for becomes a question mark.
std::string XmlText(std::string_view text) {
  std::string escaped = page::Escape(text);
  for (char& c : escaped) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 && c != '\n' && c != '\t') c = '?';
  }
  return escaped;
}

std::string LineOf(const Finding& finding) { return finding.where + ": " + SentenceOf(finding); }

std::string JunitCase(const ValidationReport& report, FailOn fail_on) {
  std::string failures;
  std::string others;
  for (const Finding& finding : report.findings) {
    if (!Fails(finding.severity, fail_on)) {
      others += XmlText(LineOf(finding)) + "\n";
      continue;
    }
    failures += "      <failure type=\"" + finding.code + "\" message=\"" +
                XmlText(finding.where + ": " + finding.measured) + "\">" +
                XmlText(LineOf(finding)) + "</failure>\n";
  }
  std::string text = "    <testcase classname=\"doorforge.validate." +
                     std::string(NameOf(report.kind)) + "\" name=\"" +
                     XmlText(report.folder.string()) + "\" time=\"0\">\n" + failures;
  if (!others.empty()) text += "      <system-out>" + others + "</system-out>\n";
  return text + "    </testcase>\n";
}

std::string GithubText(std::string_view text, bool property) {
  std::string escaped;
  for (const char c : text) {
    if (c == '%')
      escaped += "%25";
    else if (c == '\r')
      escaped += "%0D";
    else if (c == '\n')
      escaped += "%0A";
    else if (property && c == ':')
      escaped += "%3A";
    else if (property && c == ',')
      escaped += "%2C";
    else
      escaped += c;
  }
  return escaped;
}

std::string HtmlRow(const Finding& finding) {
  const ValidationRule& rule = AnyRule(finding.code);
  return page::Fill(
      "<tr><td>{code}</td><td>{severity}</td><td>{where}</td><td>{rule}</td>"
      "<td>{measured}</td><td>{allowed}</td><td>{fix}</td></tr>\n",
      {{"code", page::Escape(finding.code)},
       {"severity", std::string(NameOf(finding.severity))},
       {"where", page::Escape(finding.where)},
       {"rule", page::Escape(rule.text)},
       {"measured", page::Escape(finding.measured)},
       {"allowed", page::Escape(finding.allowed)},
       {"fix", page::Escape(finding.fix)}});
}

std::string HtmlItem(const ValidationReport& report) {
  std::string text = "<h2>" + page::Escape(report.folder.string()) + "</h2>\n<p>" +
                     std::string(NameOf(report.kind)) + ", " +
                     page::Plural(static_cast<std::size_t>(report.errors), "error") + ", " +
                     page::Plural(static_cast<std::size_t>(report.warnings), "warning") + "</p>\n";
  if (!report.notes.empty()) {
    text += "<ul>\n";
    for (const std::string& note : report.notes) text += "<li>" + page::Escape(note) + "</li>\n";
    text += "</ul>\n";
  }
  if (report.findings.empty()) return text;
  text +=
      "<table><thead><tr><th>code</th><th>severity</th><th>where</th><th>rule</th>"
      "<th>measured</th><th>allowed</th><th>to fix</th></tr></thead><tbody>\n";
  for (const Finding& finding : report.findings) text += HtmlRow(finding);
  return text + "</tbody></table>\n";
}

}  // namespace

FindingPlace PlaceOf(const ValidationReport& report, const Finding& finding) {
  FindingPlace place = finding.place;
  if (!place.file.empty()) return place;
  // "model.urdf:12: /robot/link", "door.json: handle"
  const std::string name = finding.where.substr(0, finding.where.find(':'));
  const bool named = name.ends_with(".json") || name.ends_with(".urdf") || name.ends_with(".obj");
  const std::string record = report.kind == ValidatedKind::kPart ? "part.json" : "door.json";
  place.file = (report.folder / (named ? name : record)).generic_string();
  place.element = finding.where;
  return place;
}

std::string SentenceOf(const Finding& finding) {
  return std::string(AnyRule(finding.code).text) + ": measured " + finding.measured + "; allowed " +
         finding.allowed + "; to fix: " + finding.fix;
}

Json ToSarif(std::span<const ValidationReport> reports) {
  Json rules = Json::array();
  Json results = Json::array();
  std::map<std::string, std::size_t> index;
  std::size_t all = 0;
  for (const ValidationReport& report : reports) {
    for (const Finding& finding : report.findings) {
      if (++all > kMostSarifResults) continue;
      const auto [entry, is_new] = index.emplace(finding.code, rules.size());
      if (is_new) rules.push_back(SarifRule(AnyRule(finding.code)));
      results.push_back(SarifResult(report, finding, entry->second));
    }
  }
  Json invocation = {{"executionSuccessful", true}};
  if (all > kMostSarifResults)
    invocation["toolExecutionNotifications"] = {
        {{"level", "warning"},
         {"message",
          {{"text", std::to_string(all) + " findings, of which the first " +
                        std::to_string(kMostSarifResults) + " are listed"}}}}};
  Json driver = {{"name", "doorforge validate"}, {"version", CodeVersion()}, {"rules", rules}};
  return {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
          {"version", "2.1.0"},
          {"runs",
           {{{"tool", {{"driver", driver}}},
             {"columnKind", "utf16CodeUnits"},
             {"invocations", {invocation}},
             {"results", results}}}}};
}

std::string ToJunit(std::span<const ValidationReport> reports, FailOn fail_on) {
  const auto failed = std::count_if(reports.begin(), reports.end(),
                                    [&](const auto& report) { return Fails(report, fail_on); });
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"doorforge "
      "validate\" tests=\"" +
      std::to_string(reports.size()) + "\" failures=\"" + std::to_string(failed) +
      "\" errors=\"0\" skipped=\"0\" time=\"0\">\n";
  for (const ValidationReport& report : reports) text += JunitCase(report, fail_on);
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string ToGithub(std::span<const ValidationReport> reports) {
  std::string text;
  for (const ValidationReport& report : reports) {
    for (const Finding& finding : report.findings) {
      const FindingPlace place = PlaceOf(report, finding);
      const char* command = finding.severity == Severity::kError     ? "error"
                            : finding.severity == Severity::kWarning ? "warning"
                                                                     : "notice";
      text += std::string("::") + command + " file=" + GithubText(WithoutDot(place.file), true);
      if (place.line > 0) text += ",line=" + std::to_string(place.line);
      if (place.column > 0) text += ",col=" + std::to_string(place.column);
      text += ",title=" + GithubText(finding.code, true) + "::" +
              GithubText((place.element.empty() ? "" : place.element + ": ") + SentenceOf(finding),
                         false) +
              "\n";
    }
  }
  return text;
}

std::string ToHtml(std::span<const ValidationReport> reports) {
  std::size_t errors = 0;
  std::size_t warnings = 0;
  std::string items;
  std::string passed;
  for (const ValidationReport& report : reports) {
    errors += static_cast<std::size_t>(report.errors);
    warnings += static_cast<std::size_t>(report.warnings);
    if (report.findings.empty() && report.notes.empty())
      passed += "<li>" + page::Escape(report.folder.string()) + "</li>\n";
    else
      items += HtmlItem(report);
  }
  if (!passed.empty()) items += "<h2>Without findings</h2>\n<ul>\n" + passed + "</ul>\n";
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><title>doorforge "
         "validate</title><style>" +
         std::string(page::kPageStyle) +
         "body{max-width:90rem;margin:auto;padding:1rem}td{vertical-align:top;"
         "overflow-wrap:anywhere}td:first-child{white-space:nowrap}</style></"
         "head><body>\n<h1>doorforge validate</h1>\n<p>" +
         page::Plural(reports.size(), "item") + ", " + page::Plural(errors, "error") + ", " +
         page::Plural(warnings, "warning") + "</p>\n" + items + "</body></html>\n";
}

Json ItemsToJson(std::span<const ValidationReport> reports, FailOn fail_on) {
  Json items = Json::array();
  for (const ValidationReport& report : reports) {
    Json findings = Json::array();
    for (const Finding& finding : report.findings) findings.push_back(FindingJson(report, finding));
    items.push_back({{"path", report.folder.string()},
                     {"kind", NameOf(report.kind)},
                     {"status", Fails(report, fail_on) ? "failed" : "passed"},
                     {"errors", report.errors},
                     {"warnings", report.warnings},
                     {"notes", report.notes},
                     {"findings", findings}});
  }
  return items;
}

}  // namespace doorforge

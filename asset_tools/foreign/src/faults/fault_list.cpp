// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_list.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <tuple>

#include "doorforge/foreign/foreign_rules.h"

namespace doorforge::foreign {

// Who wrote the file may have put characters into its names that a terminal obeys.
std::string Printable(const std::string& text) {
  constexpr std::size_t kLongest = 300;
  std::string shown = text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return shown;
}

std::string Digits(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", value);
  return digits;
}

Measured::Measured(double number, std::string of_unit)
    : text(Digits(number) + (of_unit.empty() ? "" : " " + of_unit)),
      value(number),
      unit(std::move(of_unit)) {}

void FaultList::Add(std::string_view code, const SourcePlace& place, const Measured& measured) {
  const ValidationRule& rule = AnyRule(code);
  if (++counts_[std::string(code)] > kMost) return;
  Finding finding{std::string(code),
                  rule.severity,
                  Printable(WhereOf(place)),
                  Printable(measured.text),
                  AllowedText(rule),
                  std::string(rule.fix),
                  false,
                  {}};
  finding.place = {place.file,     place.line,   place.column, Printable(place.element),
                   measured.value, std::nullopt, measured.unit};
  if (rule.allowed.find("{}") != std::string_view::npos) finding.place.limit = rule.limit;
  findings_.push_back(std::move(finding));
}

std::vector<Finding> FaultList::Sorted() const {
  std::map<std::string_view, int> order;
  for (const ValidationRule& rule : AllRules())
    order.emplace(rule.code, static_cast<int>(order.size()));
  std::vector<Finding> sorted = findings_;
  const auto key = [&](const Finding& finding) {
    return std::tie(order.at(finding.code), finding.place.file, finding.place.line, finding.where,
                    finding.measured);
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
  const auto same = [&](const Finding& a, const Finding& b) { return key(a) == key(b); };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const int more = counts_.at(sorted[i].code) - kMost;
    const bool last = i + 1 == sorted.size() || sorted[i + 1].code != sorted[i].code;
    if (last && more > 0)
      sorted[i].measured += " (and " + std::to_string(more) + " more of this rule)";
  }
  return sorted;
}

bool FaultList::Restore() {
  std::map<std::string_view, const ValidationRule*> rules;
  for (const ValidationRule& rule : AllRules()) rules.emplace(rule.code, &rule);
  for (const auto& [code, count] : counts_) {
    if (!rules.contains(code)) return false;
  }
  for (Finding& finding : findings_) {
    const auto found = rules.find(finding.code);
    if (found == rules.end() || !counts_.contains(finding.code)) return false;
    const ValidationRule& rule = *found->second;
    finding.severity = rule.severity;
    finding.allowed = AllowedText(rule);
    finding.fix = rule.fix;
    finding.where = Printable(finding.where);
    finding.measured = Printable(finding.measured);
    finding.place.element = Printable(finding.place.element);
    finding.place.unit = Printable(finding.place.unit);
    if (rule.allowed.find("{}") != std::string_view::npos) finding.place.limit = rule.limit;
  }
  return true;
}

bool FaultList::HasError() const {
  return std::any_of(findings_.begin(), findings_.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

bool FaultList::Has(std::string_view code) const { return counts_.contains(code); }

bool FaultList::Says(std::string_view words) const {
  return std::any_of(findings_.begin(), findings_.end(), [&](const Finding& finding) {
    return finding.measured.find(words) != std::string::npos;
  });
}

std::string WhereOf(const SourcePlace& place) {
  std::string where = place.file;
  if (place.line > 0) where += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) where += ":" + std::to_string(place.column);
  if (!place.element.empty()) where += (where.empty() ? "" : ": ") + place.element;
  return where;
}

SourcePlace PlaceOf(const std::string& file, const XmlElement& element) {
  return {file, element.line, element.column, XPathOf(element)};
}

SourcePlace PlaceOf(const std::string& file, const XmlElement& element,
                    const XmlAttribute& attribute) {
  return {file, attribute.line, attribute.column, XPathOf(element) + "/@" + attribute.name};
}

}  // namespace doorforge::foreign

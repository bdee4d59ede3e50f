// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "doorforge/conformance/conformance.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/page_style.h"

namespace doorforge {
namespace {

using Cells = std::vector<std::string>;

/// What the doors of one engine and format have in common.
struct Group {
  std::string engine;
  std::string format;
  std::vector<const ConformanceRow*> rows;
};

std::vector<Group> GroupsOf(const ConformanceReport& report) {
  std::vector<Group> groups;
  for (const ConformanceEngine& engine : report.engines) {
    for (const auto& [format, needs] : engine.loader) {
      Group group{engine.version, format, {}};
      for (const ConformanceRow& row : report.rows) {
        if (row.client == engine.name && row.format == format) group.rows.push_back(&row);
      }
      if (!group.rows.empty()) groups.push_back(std::move(group));
    }
  }
  return groups;
}

std::string Share(const Group& group, bool (*holds)(const ConformanceRow&)) {
  const auto count = std::count_if(group.rows.begin(), group.rows.end(),
                                   [&](const ConformanceRow* row) { return holds(*row); });
  return std::to_string(count) + " of " + std::to_string(group.rows.size());
}

std::vector<double> NumbersOf(const Group& group,
                              std::optional<double> (*of)(const ConformanceRow&)) {
  std::vector<double> numbers;
  for (const ConformanceRow* row : group.rows) {
    if (const auto number = of(*row)) numbers.push_back(*number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::string Largest(const std::vector<double>& numbers, int digits) {
  return numbers.empty() ? "-" : page::Fixed(numbers.back(), digits);
}

std::string Median(const std::vector<double>& numbers, int digits) {
  return numbers.empty() ? "-" : page::Fixed(numbers[numbers.size() / 2], digits);
}

std::optional<double> UnlockError(const ConformanceRow& row) {
  if (!row.unlock_deg || !row.law_unlock_deg) return std::nullopt;
  return std::abs(*row.unlock_deg - *row.law_unlock_deg);
}

const Cells kColumns = {
    "engine", "format",     "load",   "mass error",          "limit error rad",
    "held",   "held deg",   "median", "gave way under 20 N", "off the unlock angle deg",
    "opened", "s to 45 deg"};

Cells CellsOf(const Group& group) {
  const auto held = NumbersOf(group, [](const ConformanceRow& row) { return row.held_deg; });
  const auto unlocked = NumbersOf(group, UnlockError);
  return {group.engine,
          group.format,
          Share(group, [](const ConformanceRow& row) { return row.loads; }),
          Largest(NumbersOf(group, [](const ConformanceRow& row) { return row.mass_error; }), 7),
          Largest(NumbersOf(group, [](const ConformanceRow& row) { return row.limit_error; }), 7),
          Share(group, [](const ConformanceRow& row) { return row.held(); }),
          Largest(held, 2),
          Median(held, 2),
          Share(group, [](const ConformanceRow& row) { return row.unlock_deg.has_value(); }),
          Median(unlocked, 1),
          Share(group, [](const ConformanceRow& row) { return row.opened(); }),
          Median(NumbersOf(group, [](const ConformanceRow& row) { return row.open_s; }), 2)};
}

std::string Number(const std::optional<double>& number, int digits) {
  return number ? page::Fixed(*number, digits) : "-";
}

const Cells kFaultColumns = {"engine",     "format",      "door",   "held deg",
                             "unlock deg", "s to 45 deg", "problem"};

std::vector<Cells> FaultsOf(const std::vector<Group>& groups) {
  std::vector<Cells> faults;
  for (const Group& group : groups) {
    for (const ConformanceRow* row : group.rows) {
      if (row->passed()) continue;
      faults.push_back({group.engine, group.format, row->door, Number(row->held_deg, 2),
                        Number(row->unlock_deg, 1), Number(row->open_s, 2), row->problem});
    }
  }
  return faults;
}

// What is said above and below the tables.
Cells LoadersOf(const ConformanceReport& report) {
  Cells lines;
  for (const ConformanceEngine& engine : report.engines) {
    if (!engine.absent.empty()) lines.push_back(engine.name + " is absent: " + engine.absent);
    for (const auto& [format, needs] : engine.loader) {
      if (!needs.empty())
        lines.push_back(engine.version + ", " + format + ": loaded with " + needs);
    }
  }
  return lines;
}

std::string PlainTable(const Cells& head, const std::vector<Cells>& body) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < head.size(); ++i) {
    widths.push_back(head[i].size());
    for (const Cells& cells : body) widths[i] = std::max(widths[i], cells[i].size());
  }
  std::string text;
  const auto add = [&](const Cells& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      line += cells[i];
      if (i + 1 < cells.size()) line.append(widths[i] + 2 - cells[i].size(), ' ');
    }
    text += line + "\n";
  };
  add(head);
  for (const Cells& cells : body) add(cells);
  return text;
}

std::string MarkdownTable(const Cells& head, const std::vector<Cells>& body) {
  std::string text;
  const auto add = [&](const Cells& cells) {
    text += "|";
    for (std::string cell : cells) {
      std::replace(cell.begin(), cell.end(), '|', '/');
      text += " " + cell + " |";
    }
    text += "\n";
  };
  add(head);
  add(Cells(head.size(), "---"));
  for (const Cells& cells : body) add(cells);
  return text;
}

std::string HtmlTable(const Cells& head, const std::vector<Cells>& body) {
  std::string text = "<table>\n<tr>";
  for (const std::string& cell : head) text += "<th>" + page::Escape(cell) + "</th>";
  text += "</tr>\n";
  for (const Cells& cells : body) {
    text += "<tr>";
    for (const std::string& cell : cells) text += "<td>" + page::Escape(cell) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::vector<Cells> BodyOf(const std::vector<Group>& groups) {
  std::vector<Cells> body;
  for (const Group& group : groups) body.push_back(CellsOf(group));
  return body;
}

}  // namespace

std::string ToText(const ConformanceReport& report) {
  const std::vector<Group> groups = GroupsOf(report);
  std::string text;
  if (!groups.empty()) text += PlainTable(kColumns, BodyOf(groups));
  const std::vector<Cells> faults = FaultsOf(groups);
  if (!faults.empty())
    text += "\ndoes not hold, open or load:\n" + PlainTable(kFaultColumns, faults);
  for (const std::string& line : LoadersOf(report)) text += line + "\n";
  return text;
}

std::string ToMarkdown(const ConformanceReport& report) {
  const std::vector<Group> groups = GroupsOf(report);
  std::string text;
  if (!groups.empty()) text += MarkdownTable(kColumns, BodyOf(groups)) + "\n";
  const std::vector<Cells> faults = FaultsOf(groups);
  if (!faults.empty())
    text += "Does not hold, open or load:\n\n" + MarkdownTable(kFaultColumns, faults) + "\n";
  for (const std::string& line : LoadersOf(report)) text += "- " + line + "\n";
  return text;
}

std::string ToHtml(const ConformanceReport& report) {
  const std::vector<Group> groups = GroupsOf(report);
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><title>Doors in physics "
      "engines</title>\n<style>" +
      std::string(page::kPageStyle) + "</style></head><body>\n<h1>Doors in physics engines</h1>\n";
  text += HtmlTable(kColumns, BodyOf(groups));
  const std::vector<Cells> faults = FaultsOf(groups);
  if (!faults.empty())
    text += "<h2>Does not hold, open or load</h2>\n" + HtmlTable(kFaultColumns, faults);
  text += "<ul>\n";
  for (const std::string& line : LoadersOf(report)) text += "<li>" + page::Escape(line) + "</li>\n";
  return text + "</ul>\n</body></html>\n";
}

std::string DocumentOf(const ConformanceReport& report, ConformanceFormat format) {
  switch (format) {
    case ConformanceFormat::kText:
      break;
    case ConformanceFormat::kJson:
      return JsonText(ToJson(report), 2) + "\n";
    case ConformanceFormat::kHtml:
      return ToHtml(report);
    case ConformanceFormat::kMarkdown:
      return ToMarkdown(report);
  }
  return ToText(report);
}

}  // namespace doorforge

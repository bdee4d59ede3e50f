// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/named_enum.h"
#include "doorforge/exporters/export_door.h"

namespace doorforge {

/// A physics engine that can judge exports, through the program
/// share/doorforge/conformance/client_NAME.py.
struct ConformanceClient {
  std::string_view name;
  std::string_view install;  ///< What makes it available.
};

/// All of them, in the order of tables.
std::span<const ConformanceClient> ConformanceClients();
std::vector<std::string> ConformanceClientNames();

/// A door is held if its hinge stays at or below this under 75 N at the handle's distance [deg].
inline constexpr double kHeldDeg = 2;

/// What one engine found of one door in one format. Numbers are absent where they were not reached.
struct ConformanceRow {
  std::string client;
  std::string format;
  std::string door;
  bool latched = true;
  bool loads = false;
  std::string problem;                   ///< What the engine said, in one line; empty if nothing.
  std::optional<double> mass_error;      ///< Relative, the largest of leaf and handle.
  std::optional<double> limit_error;     ///< The largest of the joints' limits [rad].
  std::optional<double> held_deg;        ///< Largest hinge angle under 75 N, the handle left alone.
  std::optional<double> unlock_deg;      ///< Handle angle at which a door under 20 N gives way.
  std::optional<double> law_unlock_deg;  ///< That of the door's own latch.
  std::optional<double> open_s;          ///< To 45 degrees under 50 N, the handle kept turned.

  bool held() const { return !latched || (held_deg && *held_deg <= kHeldDeg); }
  bool opened() const { return open_s.has_value(); }
  bool passed() const { return loads && held() && opened(); }
};

/// An engine that was asked for: its version, or why it did not run and what to do about it.
struct ConformanceEngine {
  std::string name;
  std::string version;  ///< Empty if it is absent.
  std::string absent;
  std::map<std::string, std::string> loader =
      {};  ///< Each format has what loading takes beyond the file.
};

struct ConformanceReport {
  std::vector<ConformanceEngine> engines;
  std::vector<ConformanceRow> rows;
};

/// What is judged, and by whom.
struct ConformanceRun {
  std::filesystem::path out;  ///< Holds the exports afterwards, OUT/<door id>.
  std::vector<std::string> clients;
  std::vector<std::string> formats;  ///< Empty: all that a client reads.
  std::string python = "python3";    ///< Name on PATH, or path, of an interpreter with the engines.
  ExportSettings settings = {};
};

/// Exports the doors in `folders` to OUT and has each client judge those in the formats that it
/// reads: each in a child process, started again after a door that ended it. An engine that is
/// not installed is named in the report and costs nothing else. 0.2 to 20 s a door and format.
///
/// @throws Error as ReadDoor() and WriteExportedDoor(); kMissing if the programs or the interpreter
///     are not there; kIncomplete when a signal asked to stop.
ConformanceReport RunConformance(std::span<const std::filesystem::path> folders,
                                 const ConformanceRun& run);

/// A record of schema "doorforge.conformance", version 1.
nlohmann::ordered_json ToJson(const ConformanceReport& report);
/// Tables by engine and format, then the rows that do not hold, open or load.
std::string ToText(const ConformanceReport& report);
std::string ToMarkdown(const ConformanceReport& report);
std::string ToHtml(const ConformanceReport& report);

/// What a report may be written as.
enum class ConformanceFormat { kText, kJson, kHtml, kMarkdown };
inline constexpr NamedValue<ConformanceFormat> kConformanceFormats[] = {
    {ConformanceFormat::kText, "text"},
    {ConformanceFormat::kJson, "json"},
    {ConformanceFormat::kHtml, "html"},
    {ConformanceFormat::kMarkdown, "markdown"}};
constexpr std::span<const NamedValue<ConformanceFormat>> ValuesOf(ConformanceFormat) {
  return kConformanceFormats;
}
std::string DocumentOf(const ConformanceReport& report, ConformanceFormat format);

}  // namespace doorforge

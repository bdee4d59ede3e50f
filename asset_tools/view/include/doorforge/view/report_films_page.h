// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "doorforge/view/robot_source.h"
#include "doorforge/view/view_page.h"

namespace doorforge {

/// A report, or films alone, and how they are shown.
struct ReportFilms {
  /// Folder of a report that `doorforge eval` wrote, its report.json, or a file of films (one
  /// doorforge.film a line), of which the rows then are made.
  std::filesystem::path report;
  std::span<const std::filesystem::path> doors = {};  ///< Folders that hold its doors.
  ShownRobot robot = {};
  int threads = 0;  ///< 0: all processors.
};

/// Whether the path is such a report or file of films.
bool IsReport(const std::filesystem::path& path);

/// Shows the rows of a report, and of those that films.jsonl beside report.json holds (`eval
/// --films`: every failure) the film: robot and door, angles and forces over time, the action. The
/// address of a film is the page's with #<door>/<seed>/<episode> behind it. Films of which the door
/// is not found, or has changed since, or of another robot, are left out with a message.
///
/// @throws Error(kMissing) if there is no such report, or the viewer is not among the data;
///     Error(kFormat) on a report or films that do not follow their format.
ViewPage MakeReportPage(const ReportFilms& chosen);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/core/committed_file.h"
#include "doorforge/report/report.h"
#include "doorforge/report/report_page.h"

namespace doorforge {

/// The folder of a report, for StagedFolder.
inline constexpr FolderKind kReportFolder{"a report", "report.json", "doorforge.report"};

/// Writes report.json, report.html, config.yaml (the effective settings, which --config takes
/// again) and the pictures of chosen grasps below heat_maps/, and commits the folder: whoever looks
/// finds all of a report or nothing of it.
///
/// @throws Error(kIo) as CommitFile().
void WriteReportFolder(const EvaluationReport& report, const ReportPictures& pictures,
                       StagedFolder& folder);

/// Reads the record of a report's folder, or a report.json that is named itself. Throws
/// Error(kMissing) if it is not there, Error(kFormat) as ReportFromJson().
EvaluationReport ReadReport(const std::filesystem::path& place);

}  // namespace doorforge

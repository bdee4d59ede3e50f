// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/report_folder.h"

#include <string>

#include "doorforge/core/json_file.h"

namespace doorforge {

void WriteReportFolder(const EvaluationReport& report, const ReportPictures& pictures,
                       StagedFolder& folder) {
  WriteJsonFile(folder.path() / "report.json", ReportToJson(report));
  CommitFile(folder.path() / "report.html", ReportPage(report, pictures));
  CommitFile(folder.path() / "config.yaml", JsonText(report.provenance.config, 2) + "\n");
  for (const ReportGrasp& grasp : pictures.grasps)
    CommitFile(
        folder.path() / "heat_maps" /
            (std::string(NameOf(grasp.category)) + (grasp.opened ? "_opened.png" : "_failed.png")),
        grasp.picture.png);
  folder.Commit();
}

EvaluationReport ReadReport(const std::filesystem::path& place) {
  const bool is_folder = std::filesystem::is_directory(place);
  const std::string file = (is_folder ? place / "report.json" : place).string();
  return ReportFromJson(ReadJsonFile(file), file);
}

}  // namespace doorforge

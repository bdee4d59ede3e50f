// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/evaluation_folder.h"

#include <string>
#include <vector>

#include "doorforge/core/program.h"
#include "doorforge/report/report_folder.h"

namespace doorforge {

namespace fs = std::filesystem;

void WriteEvaluation(const Evaluation& evaluation, StagedFolder& folder) {
  if (!evaluation.films.empty()) WriteFilms(folder.path() / "films.jsonl", evaluation.films);
  WriteReportFolder(evaluation.report, evaluation.pictures, folder);
}

std::optional<int> MakeFilmsPage(const fs::path& folder, std::span<const fs::path> doors) {
  for (const fs::path& programs : ProgramFolders()) {
    const fs::path program = programs / "doorforge-assets";
    if (!fs::exists(program)) continue;
    const std::string page = (folder / "films.html").string();
    std::vector<std::string> command = {program.string(), "view", folder.string(),
                                        "--out",          page,   "--doors"};
    for (const fs::path& one : doors) command.push_back(one.string());
    return RunChild(command, ChildOutput::kStandardError);
  }
  return std::nullopt;
}

}  // namespace doorforge

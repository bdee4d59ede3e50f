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

EvaluatedFolder EvaluateIntoFolder(EvaluationRequest request, const fs::path& out,
                                   Existing existing) {
  std::optional<StagedFolder> staged;
  request.pictures = !out.empty();
  if (request.pictures) staged.emplace(out, kReportFolder, existing);
  EvaluatedFolder done;
  done.evaluation = EvaluateOpener(request);
  for (const std::string& note : done.evaluation.notes) done.notes.push_back("note: " + note);
  if (!staged) return done;
  WriteEvaluation(done.evaluation, *staged);
  done.notes.push_back("report: " + fs::absolute(out / "report.html").lexically_normal().string());
  if (done.evaluation.films.empty()) return done;
  const auto made = MakeFilmsPage(out, request.doors.folders);
  if (!made)
    done.notes.emplace_back(
        "doorforge: films.html: doorforge-assets, which makes it, is not installed");
  done.code = made.value_or(1);
  return done;
}

}  // namespace doorforge

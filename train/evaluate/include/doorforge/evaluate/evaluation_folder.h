// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/evaluate/evaluate_opener.h"

namespace doorforge {

/// Writes films.jsonl, if there are films, and what WriteReportFolder() writes, and commits the
/// folder. Throws as that.
void WriteEvaluation(const Evaluation& evaluation, StagedFolder& folder);

/// Makes films.html in the folder of an evaluation with films, by `doorforge view`: a program of
/// its own for its licence. Returns its exit code; nothing where it is not installed.
///
/// @param doors Folders that hold the doors of the evaluation.
std::optional<int> MakeFilmsPage(const std::filesystem::path& folder,
                                 std::span<const std::filesystem::path> doors);

struct EvaluatedFolder {
  Evaluation evaluation;
  /// What was written where, and what could not be, a sentence each, for people.
  std::vector<std::string> notes;
  int code = 0;  ///< Exit code of the program that made the films' page; 1 where it is missing.
};

/// Evaluates and writes the folder `out` with pages and pictures; with an empty `out` nothing is
/// written or drawn. Refuses a folder that is there before hours of work, not after.
///
/// @throws Error as StagedFolder, EvaluateOpener() and WriteEvaluation().
EvaluatedFolder EvaluateIntoFolder(EvaluationRequest request, const std::filesystem::path& out,
                                   Existing existing);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>

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

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/mesh/repair_mesh.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {

/// What came of a mesh file.
struct RepairedFile {
  RepairResult result;
  /// The report, with path and hash of the input, the settings, their hash, and this build.
  nlohmann::ordered_json record;
};

/// Reads a mesh file with ImportMesh() and repairs its pieces as one mesh.
///
/// @param max_seconds Processor time that it may take [s].
/// @throws Error as ImportMesh() does; Error(kInvalidConfig) on a setting out of its range;
///     Error(kFormat) where time or memory do not suffice.
RepairedFile RepairMeshFile(const std::filesystem::path& input, const RepairConfig& config,
                            double max_seconds = kObjectSeconds);

/// The report for people: the outcome, the steps on lines of their own, sizes and deviations.
std::string RepairText(const RepairReport& report);

}  // namespace doorforge

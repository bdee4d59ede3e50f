// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/core/committed_file.h"

namespace doorforge {

/// Builds parts of the catalogue and writes each to OUT/<id>, with progress. Whatever is wrong with
/// one, the others go on. Returns what is wrong with each, in their order; empty if it was built.
///
/// @param threads 0: all processors.
/// @throws Error(kIo) if the folder cannot be written.
std::vector<std::string> BuildParts(std::span<const CatalogueEntry> entries,
                                    const std::filesystem::path& out, Existing existing,
                                    int threads);

/// {"schema": "doorforge.catalog_build", "parts": [EntryToJson() and "built", "message"]}.
///
/// @param problems What BuildParts() returned of the entries.
nlohmann::ordered_json BuiltToJson(std::span<const CatalogueEntry> entries,
                                   std::span<const std::string> problems);

}  // namespace doorforge

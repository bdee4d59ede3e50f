// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/catalogue/catalogue.h"

namespace doorforge {

/// Which parts of the catalogue are meant.
struct CatalogueSelection {
  std::string category = {};  ///< This is its name; empty: all.
  std::string split = {};     ///< A name in data/splits, or a file of the user's; empty: all.
};

/// The entries that are meant, in the order of the catalogue, or of the split's ids. Throws
/// Error(kInvalidArgument) on an unknown category, Error(kMissing) if none is left; else as
/// ListCatalogue() and ReadSplit().
std::vector<CatalogueEntry> SelectParts(const std::filesystem::path& data_folder,
                                        const CatalogueSelection& selection);

/// {"id", "role", "category", "mechanism", "family"}.
nlohmann::ordered_json EntryToJson(const CatalogueEntry& entry);

/// {"schema": "doorforge.catalog", "parts": [EntryToJson()]}.
nlohmann::ordered_json CatalogueToJson(const std::vector<CatalogueEntry>& entries);
/// Says it for people, in one line an entry.
std::string CatalogueText(const std::vector<CatalogueEntry>& entries);

/// {"schema": "doorforge.catalog_part"}: the entry, its recipe and hash, where the handle or the
/// grasp goes, and name, triangles, hulls, mass and size of each piece.
nlohmann::ordered_json DescribePart(const CatalogueEntry& entry, const Part& part);
/// Says it for people, without size and grasp.
std::string PartText(const CatalogueEntry& entry, const Part& part);

}  // namespace doorforge

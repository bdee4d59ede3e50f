// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/core/error.h"

namespace doorforge {

inline std::filesystem::path DataOfSource() {
  return std::filesystem::path(DOORFORGE_SOURCE_DIR) / "data";
}

/// A part of every recipe of the catalogue, in its order; built once in a program.
inline const std::vector<Part>& AllParts() {
  static const std::vector<Part> kParts = [] {
    std::vector<Part> parts;
    for (const CatalogueEntry& entry : ListCatalogue(DataOfSource()))
      parts.push_back(BuildCataloguePart(entry));
    return parts;
  }();
  return kParts;
}

inline const Part& PartNamed(const std::string& id) {
  for (const Part& part : AllParts()) {
    if (part.id == id) return part;
  }
  throw Error(ErrorCode::kMissing, id);
}

}  // namespace doorforge

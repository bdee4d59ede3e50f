// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "doorforge/schemas/part_identity.h"

namespace doorforge {

/// The parts of the doors that a policy was trained on: it knows them on any other door, too.
struct SeenParts {
  std::vector<PartIdentity> bodies;   ///< Sorted by id, then hash; each once.
  std::vector<PartIdentity> handles;  ///< They are told apart in the same way.

  bool empty() const { return bodies.empty() && handles.empty(); }
  bool Holds(const PartIdentity& body, const PartIdentity& handle) const;  ///< One of the two.
};

/// All of both.
SeenParts Union(const SeenParts& a, const SeenParts& b);

/// The parts of all doors that a data set's `provenance.json` names. Throws Error(kMissing or
/// kFormat).
SeenParts SeenPartsOfDataset(const std::filesystem::path& folder);

/// {"bodies": [...], "handles": [...]}, see IdentityToJson().
nlohmann::ordered_json SeenPartsToJson(const SeenParts& parts);
SeenParts SeenPartsFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge

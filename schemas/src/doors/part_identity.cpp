// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/part_identity.h"

#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"

namespace doorforge {

bool PartIdentity::SameAs(const PartIdentity& other) const {
  return id == other.id || sha256 == other.sha256 || SameShape(shape, other.shape);
}

PartIdentity IdentityOf(const Part& part) { return {part.id, ContentHash(part), ShapeOf(part)}; }

nlohmann::ordered_json IdentityToJson(const PartIdentity& identity) {
  nlohmann::ordered_json json{{"id", identity.id}, {"sha256", identity.sha256}};
  if (!identity.shape.empty()) json["shape"] = identity.shape;
  return json;
}

PartIdentity IdentityFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  return {IdOf(json, "id", path), ValueOf<std::string>(json, "sha256", path),
          ShapeOfRecord(json, path)};
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/seen_parts.h"

#include <algorithm>
#include <tuple>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

std::vector<PartIdentity> SortedOnce(std::vector<PartIdentity> parts) {
  const auto key = [](const PartIdentity& part) { return std::tie(part.id, part.sha256); };
  std::ranges::sort(parts, {}, key);
  const auto same = [&](const PartIdentity& a, const PartIdentity& b) { return key(a) == key(b); };
  parts.erase(std::unique(parts.begin(), parts.end(), same), parts.end());
  return parts;
}

Json PartsToJson(const std::vector<PartIdentity>& parts) {
  Json json = Json::array();
  for (const PartIdentity& part : parts) json.push_back(IdentityToJson(part));
  return json;
}

std::vector<PartIdentity> PartsFromJson(const Json& json, const std::string& path) {
  if (!json.is_array()) throw Error(ErrorCode::kFormat, path + ": expected an array");
  std::vector<PartIdentity> parts;
  for (std::size_t i = 0; i < json.size(); ++i)
    parts.push_back(IdentityFromJson(json[i], path + "[" + std::to_string(i) + "]"));
  return parts;
}

bool IsAmong(const PartIdentity& part, const std::vector<PartIdentity>& known) {
  return std::ranges::any_of(known, [&](const PartIdentity& one) { return part.SameAs(one); });
}

}  // namespace

bool SeenParts::Holds(const PartIdentity& body, const PartIdentity& handle) const {
  return IsAmong(body, bodies) || IsAmong(handle, handles);
}

SeenParts Union(const SeenParts& a, const SeenParts& b) {
  SeenParts all = a;
  all.bodies.insert(all.bodies.end(), b.bodies.begin(), b.bodies.end());
  all.handles.insert(all.handles.end(), b.handles.begin(), b.handles.end());
  return {SortedOnce(std::move(all.bodies)), SortedOnce(std::move(all.handles))};
}

SeenParts SeenPartsOfDataset(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "provenance.json";
  SeenParts parts;
  for (const DatasetDoor& door : ProvenanceFromJson(ReadJsonFile(path), path.string()).doors) {
    parts.bodies.push_back(door.body);
    parts.handles.push_back(door.handle);
  }
  return Union(parts, {});
}

Json SeenPartsToJson(const SeenParts& parts) {
  return {{"bodies", PartsToJson(parts.bodies)}, {"handles", PartsToJson(parts.handles)}};
}

SeenParts SeenPartsFromJson(const Json& json, const std::string& path) {
  return {PartsFromJson(MemberOf(json, "bodies", path), path + ".bodies"),
          PartsFromJson(MemberOf(json, "handles", path), path + ".handles")};
}

}  // namespace doorforge

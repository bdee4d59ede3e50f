// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/importers/author_place.h"

#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "doorforge.authored_handles";

fs::path FileIn(const fs::path& body_folder) { return body_folder / "handles.json"; }

}  // namespace

AuthorPlaces ReadAuthorPlaces(const fs::path& body_folder) {
  const fs::path file = FileIn(body_folder);
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  const std::string path = file.string();
  const Json json = ReadJsonFile(file);
  RequireSchema(json, kSchema, 1, path);
  AuthorPlaces places;
  for (const Json& entry : MemberOf(json, "handles", path))
    places[ValueOf<std::string>(entry, "source_sha256", path)] = TransformFromJson(
        MemberOf(entry, "body_from_handle", path), path + ".handles.body_from_handle");
  return places;
}

void RememberAuthorPlaces(const fs::path& body_folder, const AuthorPlaces& places) {
  AuthorPlaces all = places;
  all.merge(ReadAuthorPlaces(body_folder));  // new ones win
  Json handles = Json::array();
  for (const auto& [source_sha256, body_from_handle] : all)
    handles.push_back({{"source_sha256", source_sha256},
                       {"body_from_handle", TransformToJson(body_from_handle)}});
  WriteJsonFile(FileIn(body_folder),
                {{"schema", kSchema}, {"schema_version", 1}, {"handles", handles}});
}

}  // namespace doorforge

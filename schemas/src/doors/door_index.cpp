// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_index.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kIndexSchema = "doorforge.door_index";
constexpr std::uint64_t kMaxIndexBytes = 256ULL << 20;
constexpr std::uint64_t kMaxIndexedRecordBytes = 64ULL << 20;

std::string HashIn(const Json& json, const char* key, const std::string& path) {
  auto hash = ValueOf<std::string>(json, key, path);
  if (hash.size() != 64 || hash.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw Error(ErrorCode::kFormat,
                path + "." + key + ": expected 64 lower-case hexadecimal digits");
  return hash;
}

std::vector<PartIdentity> PartsIn(const Json& json, const std::string& path) {
  const Json& list = MemberOf(json, "parts", path);
  Require(list.is_array(), ErrorCode::kFormat, path + ".parts: expected a list");
  std::vector<PartIdentity> parts;
  for (const Json& part : list) parts.push_back(IdentityFromJson(part, path + ".parts"));
  return parts;
}

const PartIdentity& PartAt(const std::vector<PartIdentity>& parts, const Json& door,
                           const char* role, const std::string& path) {
  const auto place = ValueOf<std::uint64_t>(door, role, path);
  if (place >= parts.size())
    throw Error(ErrorCode::kFormat, path + "." + role + ": found " + std::to_string(place) +
                                        ", but the index lists " + std::to_string(parts.size()) +
                                        " parts");
  return parts[place];
}

DoorIdentity DoorFromJson(const Json& json, const std::vector<PartIdentity>& parts,
                          const std::string& path) {
  const auto category = CategoryNamed(ValueOf<std::string>(json, "category", path));
  const auto mechanism = MechanismNamed(ValueOf<std::string>(json, "mechanism", path));
  if (!category || !mechanism)
    throw Error(ErrorCode::kFormat, path + ": unknown category or mechanism");
  return {.id = IdOf(json, "id", path),
          .category = *category,
          .mechanism = *mechanism,
          .body = PartAt(parts, json, "body", path),
          .handle = PartAt(parts, json, "handle", path),
          .sha256 = HashIn(json, "sha256", path),
          .license = ValueOf<std::string>(json, "license", path)};
}

/// The parts of doors, each once, in the order of their texts.
class PartList {
 public:
  void Add(const PartIdentity& part) { places_.emplace(JsonText(IdentityToJson(part)), 0); }

  void Number() {
    std::size_t next = 0;
    for (auto& [text, place] : places_) place = next++;
  }

  std::size_t PlaceOf(const PartIdentity& part) const {
    return places_.at(JsonText(IdentityToJson(part)));
  }

  std::vector<std::string> Texts() const {
    std::vector<std::string> texts;
    for (const auto& [text, place] : places_) texts.push_back(text);
    return texts;
  }

 private:
  std::map<std::string, std::size_t> places_;
};

std::string Lines(const std::vector<std::string>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += "    " + rows[i] + (i + 1 < rows.size() ? ",\n" : "\n");
  return text;
}

std::vector<fs::path> DoorFoldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!entry.path().filename().string().starts_with('.') &&
        fs::is_regular_file(entry.path() / "door.json"))
      folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

struct IndexEntry {
  std::string record_sha256;
  DoorIdentity identity;
};

std::optional<IndexEntry> EntryOf(const fs::path& folder, DoorIdentifier& identifier) {
  try {
    const fs::path file = folder / "door.json";
    const std::string record = ReadFile(file, kMaxIndexedRecordBytes);
    return IndexEntry{Sha256Hex(record),
                      identifier.Identify(ParseJson(record, file.string()), folder)};
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

DoorIndex DoorIndex::FromJson(const Json& json, const std::string& path) {
  RequireSchema(json, kIndexSchema, kDoorIndexSchemaVersion, path);
  const std::vector<PartIdentity> parts = PartsIn(json, path);
  const Json& doors = MemberOf(json, "doors", path);
  Require(doors.is_array(), ErrorCode::kFormat, path + ".doors: expected a list");
  DoorIndex index;
  for (std::size_t i = 0; i < doors.size(); ++i) {
    const std::string place = path + ".doors[" + std::to_string(i) + "]";
    std::string record = HashIn(doors[i], "record_sha256", place);
    if (!index.doors_.emplace(record, DoorFromJson(doors[i], parts, place)).second)
      throw Error(ErrorCode::kFormat, place + ": a second entry for one door.json");
  }
  return index;
}

const DoorIdentity* DoorIndex::Find(const std::string& record_sha256) const {
  const auto found = doors_.find(record_sha256);
  return found == doors_.end() ? nullptr : &found->second;
}

void DoorIndex::Add(const std::string& record_sha256, DoorIdentity identity) {
  doors_.insert_or_assign(record_sha256, std::move(identity));
}

std::string DoorIndex::ToText() const {
  PartList parts;
  for (const auto& [record, door] : doors_) {
    parts.Add(door.body);
    parts.Add(door.handle);
  }
  parts.Number();
  std::vector<std::string> rows;
  for (const auto& [record, door] : doors_) {
    rows.push_back(JsonText({{"id", door.id},
                             {"record_sha256", record},
                             {"sha256", door.sha256},
                             {"category", NameOf(door.category)},
                             {"mechanism", NameOf(door.mechanism)},
                             {"license", door.license},
                             {"body", parts.PlaceOf(door.body)},
                             {"handle", parts.PlaceOf(door.handle)}}));
  }
  std::sort(rows.begin(), rows.end());  // by id
  return "{\n  \"schema\": \"" + std::string(kIndexSchema) +
         "\",\n  \"schema_version\": " + std::to_string(kDoorIndexSchemaVersion) +
         ",\n  \"parts\": [\n" + Lines(parts.Texts()) + "  ],\n  \"doors\": [\n" + Lines(rows) +
         "  ]\n}\n";
}

DoorIndex ReadDoorIndex(const fs::path& folder) {
  const fs::path file = folder / kDoorIndexFile;
  if (!fs::exists(fs::symlink_status(file))) return {};
  try {
    return DoorIndex::FromJson(ParseJson(ReadFile(file, kMaxIndexBytes), file.string()),
                               file.string());
  } catch (const Error& error) {
    throw Error(error.code(), std::string(error.what()) +
                                  "; remove this file, it only saves time, or give the command of "
                                  "`doorforge compose` that made the doors again");
  }
}

void WriteDoorIndex(const fs::path& folder, int threads) {
  const std::vector<fs::path> folders = DoorFoldersIn(folder);
  std::vector<std::optional<IndexEntry>> entries(folders.size());
  DoorIdentifier identifier;
  Progress progress("indexing", folders.size());
  ParallelFor(folders.size(), threads, [&](std::size_t i) {
    entries[i] = EntryOf(folders[i], identifier);
    progress.Advance();
  });
  DoorIndex index;
  for (std::optional<IndexEntry>& entry : entries) {
    if (entry) index.Add(entry->record_sha256, std::move(entry->identity));
  }
  CommitFile(folder / kDoorIndexFile, index.ToText());
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/validate/missing_records.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/schemas/door_index.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxRecordBytes = 64ULL << 20;

bool Holds(const fs::path& folder, const char* file) {
  std::error_code error;
  return fs::is_regular_file(folder / file, error);
}

bool HoldsRecord(const fs::path& folder) {
  return Holds(folder, "door.json") || Holds(folder, "part.json");
}

// The folders directly below that hold a door.
std::vector<fs::path> DoorsIn(const fs::path& folder) {
  std::vector<fs::path> doors;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (Holds(entry.path(), "door.json")) doors.push_back(entry.path());
  }
  return doors;
}

// These are the hashes of doors whose folders have another name than any entry of the index.
std::set<std::string> RenamedHashes(const fs::path& folder, const std::set<std::string>& ids) {
  std::set<std::string> hashes;
  for (const fs::path& door : DoorsIn(folder)) {
    if (!ids.contains(door.filename().string()))
      hashes.insert(Sha256Hex(ReadFile(door / "door.json", kMaxRecordBytes)));
  }
  return hashes;
}

// An index that cannot be read only saves time, and says nothing here.
DoorIndex IndexIn(const fs::path& folder) {
  try {
    return ReadDoorIndex(folder);
  } catch (const Error&) {
    return {};
  }
}

void AddFromIndex(const fs::path& folder, std::vector<MissingRecord>& missing) {
  if (!Holds(folder, kDoorIndexFile)) return;
  const DoorIndex index = IndexIn(folder);
  std::set<std::string> ids;
  for (const auto& [hash, door] : index.doors()) ids.insert(door.id);
  const bool all_there = std::all_of(ids.begin(), ids.end(), [&](const std::string& id) {
    return Holds(folder / id, "door.json");
  });
  if (all_there) return;
  const std::set<std::string> renamed = RenamedHashes(folder, ids);
  for (const auto& [hash, door] : index.doors()) {
    if (!Holds(folder / door.id, "door.json") && !renamed.contains(hash))
      missing.push_back({folder / door.id, "door.json", (folder / kDoorIndexFile).string()});
  }
}

// Other files tell what a folder without a record was.
void AddFromRemains(const fs::path& folder, std::vector<MissingRecord>& missing) {
  const bool composed =
      Holds(folder, "compose.json") || Holds(folder.parent_path(), "compose.json");
  if (composed && Holds(folder, "model.urdf"))
    missing.push_back({folder, "door.json", "model.urdf of `doorforge compose` beside it"});
  else if (Holds(folder, "repair.json"))
    missing.push_back({folder, "part.json", "repair.json of `doorforge import` beside it"});
}

void Search(const fs::path& path, std::vector<MissingRecord>& missing) {
  AddFromIndex(path, missing);
  AddFromRemains(path, missing);
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(path, error);
  for (; !error && entry != fs::end(entry); entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored)) continue;
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (hidden || HoldsRecord(entry->path())) {
      entry.disable_recursion_pending();
      continue;
    }
    AddFromIndex(entry->path(), missing);
    AddFromRemains(entry->path(), missing);
  }
}

}  // namespace

std::vector<MissingRecord> FindMissingRecords(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error) || HoldsRecord(path)) return {};
  std::vector<MissingRecord> found;
  // "doors/" has an empty last part, and its parent would be itself
  const fs::path folder = path.has_filename() ? path : path.parent_path();
  Search(folder, found);
  std::map<fs::path, MissingRecord> by_folder;
  for (MissingRecord& record : found) by_folder.emplace(record.folder, std::move(record));
  std::vector<MissingRecord> missing;
  for (auto& [name, record] : by_folder) missing.push_back(std::move(record));
  return missing;
}

}  // namespace doorforge

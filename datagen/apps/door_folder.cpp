// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "door_folder.h"

#include <algorithm>
#include <optional>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/parallel_for.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> FindDoors(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::kMissing, folder.string() + ": no such folder of doors");
  std::set<fs::path> found;
  if (fs::exists(folder / "door.json")) found.insert(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename() == "door.json") found.insert(entry.path().parent_path());
  }
  if (found.empty())
    throw Error(ErrorCode::kMissing, folder.string() +
                                         ": no door.json at or below this folder; "
                                         "`doorforge compose` makes doors");
  return {found.begin(), found.end()};
}

struct ReadResult {
  std::optional<DoorAsset> door;
  std::string problem;
};

std::vector<DoorAsset> DoorsOf(std::vector<ReadResult> results) {
  std::vector<DoorAsset> doors;
  std::string problems;
  for (ReadResult& result : results) {
    if (!result.problem.empty()) problems += "\n  " + result.problem;
    if (result.door) doors.push_back(std::move(*result.door));
  }
  if (!problems.empty())
    throw Error(ErrorCode::kFormat,
                "doors that cannot be read (`doorforge validate` says more):" + problems);
  std::sort(doors.begin(), doors.end(),
            [](const DoorAsset& a, const DoorAsset& b) { return a.id < b.id; });
  for (std::size_t i = 1; i < doors.size(); ++i)
    Require(doors[i - 1].id != doors[i].id, ErrorCode::kInvalidArgument,
            "two doors are called " + doors[i].id);
  return doors;
}

}  // namespace

DoorFolder ReadDoorFolder(const fs::path& folder, int threads) {
  const std::vector<fs::path> paths = FindDoors(folder);
  std::vector<ReadResult> results(paths.size());
  ParallelFor(paths.size(), threads, [&](std::size_t i) {
    try {
      results[i].door = ReadDoor(paths[i]);
    } catch (const Error& error) {
      results[i].problem = error.what();
    }
  });
  DoorFolder doors;
  doors.doors = DoorsOf(std::move(results));
  doors.sha256.resize(doors.doors.size());
  ParallelFor(doors.doors.size(), threads,
              [&](std::size_t i) { doors.sha256[i] = ContentHash(doors.doors[i]); });
  return doors;
}

std::vector<DoorParts> PartsOf(const DoorFolder& folder) {
  std::vector<DoorParts> parts;
  for (const DoorAsset& door : folder.doors)
    parts.push_back({door.id, std::string(NameOf(door.category)),
                     std::string(NameOf(door.mechanism)), door.body, door.handle});
  return parts;
}

std::vector<DatasetDoor> RecordsOf(const DoorFolder& folder) {
  std::vector<DatasetDoor> records;
  for (std::size_t i = 0; i < folder.doors.size(); ++i) {
    const DoorAsset& door = folder.doors[i];
    records.push_back({door.id, folder.sha256[i], std::string(NameOf(door.category)),
                       std::string(NameOf(door.mechanism)), door.body, door.handle, door.license,
                       ""});
  }
  return records;
}

std::string ContentHash(const DoorFolder& folder) {
  Sha256 hash;
  for (std::size_t i = 0; i < folder.doors.size(); ++i)
    hash.Update(folder.doors[i].id + "\n" + folder.sha256[i] + "\n");
  return hash.HexDigest();
}

}  // namespace doorforge

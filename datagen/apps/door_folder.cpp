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
  std::optional<DatasetDoor> door;
  std::string problem;
};

// Reads the door, and keeps what identifies it.
DatasetDoor Identify(const fs::path& folder) {
  DoorAsset door = ReadDoor(folder);
  std::string sha256 = ContentHash(door);
  return {std::move(door.id),
          std::move(sha256),
          std::string(NameOf(door.category)),
          std::string(NameOf(door.mechanism)),
          std::move(door.body),
          std::move(door.handle),
          std::move(door.license),
          ""};
}

void RequireReadable(const std::vector<ReadResult>& results) {
  constexpr int kMostNamed = 20;
  int count = 0;
  std::string problems;
  for (const ReadResult& result : results) {
    if (result.problem.empty()) continue;
    if (++count <= kMostNamed) problems += "\n  " + result.problem;
  }
  if (count > kMostNamed) problems += "\n  and " + std::to_string(count - kMostNamed) + " more";
  if (count > 0)
    throw Error(ErrorCode::kFormat,
                std::to_string(count) +
                    " doors cannot be read (`doorforge validate` says more):" + problems);
}

}  // namespace

DoorFolder ReadDoorFolder(const fs::path& folder, int threads) {
  const std::vector<fs::path> paths = FindDoors(folder);
  std::vector<ReadResult> results(paths.size());
  ParallelFor(paths.size(), threads, [&](std::size_t i) {
    try {
      results[i].door = Identify(paths[i]);
    } catch (const Error& error) {
      results[i].problem = error.what();
    }
  });
  RequireReadable(results);
  std::map<std::string, std::size_t> by_id;
  for (std::size_t i = 0; i < results.size(); ++i)
    Require(by_id.emplace(results[i].door->id, i).second, ErrorCode::kInvalidArgument,
            "two doors are called " + results[i].door->id);
  DoorFolder doors;
  for (const auto& [id, i] : by_id) {
    doors.doors.push_back(std::move(*results[i].door));
    doors.paths.push_back(paths[i]);
  }
  return doors;
}

std::vector<DoorParts> PartsOf(const DoorFolder& folder) {
  std::vector<DoorParts> parts;
  for (const DatasetDoor& door : folder.doors)
    parts.push_back({door.id, door.category, door.mechanism, door.body, door.handle});
  return parts;
}

std::string ContentHash(const DoorFolder& folder) {
  Sha256 hash;
  for (const DatasetDoor& door : folder.doors) hash.Update(door.id + "\n" + door.sha256 + "\n");
  return hash.HexDigest();
}

std::shared_ptr<const DoorAsset> DoorShelf::Take(std::size_t door) {
  constexpr std::size_t kMostKept = 32;
  {
    const std::scoped_lock lock(mutex_);
    const auto found = places_.find(door);
    if (found != places_.end()) {
      found->second.taken_at = ++clock_;
      return found->second.door;
    }
  }
  auto read = std::make_shared<const DoorAsset>(ReadDoor(folder_.paths.at(door)));
  if (ContentHash(*read) != folder_.doors[door].sha256)
    throw Error(ErrorCode::kFormat, folder_.paths[door].string() +
                                        ": the door has changed since this run began; put it back "
                                        "as it was, or collect anew in another folder");
  const std::scoped_lock lock(mutex_);
  if (places_.size() >= kMostKept)
    places_.erase(std::min_element(
        places_.begin(), places_.end(),
        [](const auto& a, const auto& b) { return a.second.taken_at < b.second.taken_at; }));
  places_[door] = {read, ++clock_};
  return read;
}

}  // namespace doorforge

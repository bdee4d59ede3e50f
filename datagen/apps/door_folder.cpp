// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "door_folder.h"

#include <algorithm>
#include <optional>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/find_doors.h"
#include "doorforge/schemas/split.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

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

// Folders among the names, and the split.
struct NamedDoors {
  std::vector<fs::path> folders;
  std::optional<std::string> split;
};

// The file of a split, if the name, without its side, is one.
fs::path SplitFile(const std::string& name) {
  const std::string stem = name.substr(0, name.rfind(':'));
  const bool is_file = stem.ends_with(".yaml") || stem.ends_with(".json");
  if (is_file && fs::is_regular_file(stem)) return stem;
  const fs::path own = DataFolder() / "splits" / (stem + ".yaml");
  return fs::is_regular_file(own) ? own : fs::path();
}

NamedDoors Divide(const std::vector<std::string>& names) {
  NamedDoors named;
  for (const std::string& name : names) {
    if (fs::is_directory(name) || SplitFile(name).empty()) {
      named.folders.emplace_back(name);
      continue;
    }
    Require(!named.split, ErrorCode::kInvalidArgument,
            "--doors " + name + ": a second split; give one");
    named.split = name;
  }
  if (named.folders.empty())
    throw Error(ErrorCode::kInvalidArgument,
                "--doors: " + (named.split ? "the split " + *named.split + " names parts; " : "") +
                    "give a folder of composed doors as well, such as `--doors full:train doors`; "
                    "`doorforge catalog build` and `doorforge compose --all` make them");
  return named;
}

std::set<std::string> PartsOfSide(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  const std::string side = colon == std::string::npos ? "train" : name.substr(colon + 1);
  const Split split = ReadSplit(SplitFile(name));
  const std::map<std::string, const std::vector<std::string>*> sides = {
      {"train", &split.train},
      {"test", &split.test},
      {"unseen_categories", &split.unseen_categories}};
  const auto found = sides.find(side);
  Require(found != sides.end(), ErrorCode::kInvalidArgument,
          "--doors " + name + ": unknown side \"" + side +
              "\"; allowed are train, test, unseen_categories");
  return {found->second->begin(), found->second->end()};
}

// Of the doors, those with both parts on the split's side. Reads no mesh.
std::vector<fs::path> OfSplit(const std::vector<fs::path>& doors, const std::string& name,
                              int threads) {
  const std::set<std::string> parts = PartsOfSide(name);
  std::vector<char> is_meant(doors.size());
  ParallelFor(doors.size(), threads, [&](std::size_t i) {
    const std::string path = (doors[i] / "door.json").string();
    const nlohmann::ordered_json json = ReadJsonFile(path);
    const auto id_of = [&](const char* role) {
      return ValueOf<std::string>(MemberOf(json, role, path), "id", path);
    };
    is_meant[i] = parts.contains(id_of("body")) && parts.contains(id_of("handle")) ? 1 : 0;
  });
  std::vector<fs::path> meant;
  for (std::size_t i = 0; i < doors.size(); ++i) {
    if (is_meant[i] != 0) meant.push_back(doors[i]);
  }
  if (meant.empty())
    throw Error(ErrorCode::kMissing, "none of the " + std::to_string(doors.size()) +
                                         " doors has body and handle of " + name +
                                         "; compose doors of its parts");
  return meant;
}

// Folders of all doors that are meant.
std::vector<fs::path> PathsOf(const std::vector<std::string>& names, int threads) {
  const NamedDoors named = Divide(names);
  const std::set<fs::path> found = FindDoors(named.folders);
  std::vector<fs::path> paths(found.begin(), found.end());
  return named.split ? OfSplit(paths, *named.split, threads) : paths;
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

DoorFolder ReadDoors(const std::vector<std::string>& names, int threads) {
  const std::vector<fs::path> paths = PathsOf(names, threads);
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

DoorFolder FindRecordedDoors(const std::vector<std::string>& names,
                             const std::vector<DatasetDoor>& recorded, int threads) {
  const std::vector<fs::path> paths = PathsOf(names, threads);
  std::vector<std::string> ids(paths.size());
  ParallelFor(paths.size(), threads, [&](std::size_t i) {
    const fs::path record = paths[i] / "door.json";
    ids[i] = ValueOf<std::string>(ReadJsonFile(record), "id", record.string());
  });
  std::map<std::string, fs::path> by_id;
  for (std::size_t i = 0; i < paths.size(); ++i) by_id[ids[i]] = paths[i];
  DoorFolder doors{recorded, {}};
  bool any = false;
  for (const DatasetDoor& door : recorded) {
    const auto found = by_id.find(door.id);
    doors.paths.push_back(found == by_id.end() ? fs::path() : found->second);
    any = any || found != by_id.end();
  }
  Require(any, ErrorCode::kInvalidArgument,
          "--doors: none of the dataset's doors is among the " + std::to_string(paths.size()) +
              " there, such as " + recorded.at(0).id);
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
  if (folder_.paths.at(door).empty())
    throw Error(ErrorCode::kMissing,
                "door \"" + folder_.doors[door].id + "\": not in the folders of --doors");
  auto read = std::make_shared<const DoorAsset>(ReadDoor(folder_.paths[door]));
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

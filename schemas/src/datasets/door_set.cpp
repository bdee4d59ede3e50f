// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_set.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/schemas/door_draw.h"
#include "doorforge/schemas/door_index.h"
#include "doorforge/schemas/find_doors.h"
#include "doorforge/schemas/split.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostKept = 32;
constexpr std::size_t kManyDoors = 200;  // worth a line of progress
constexpr std::uint64_t kMaxRecordBytes = 64ULL << 20;

/// A split's file and a side, as "my.yaml:test" names them.
struct SplitSide {
  fs::path file;
  std::string side;
};

SplitSide SplitSideOf(const std::string& name, const std::string& default_side) {
  const std::size_t colon = name.rfind(':');
  const std::string stem = name.substr(0, colon);
  const std::string side = colon == std::string::npos ? default_side : name.substr(colon + 1);
  const fs::path own = DataFolder() / "splits" / (stem + ".yaml");
  return {fs::is_regular_file(own) ? own : fs::path(stem), side};
}

bool NamesASplit(const std::string& word) {
  if (fs::is_directory(word)) return false;
  const fs::path file = SplitSideOf(word, "").file;
  return fs::is_regular_file(file) && (file.extension() == ".yaml" || file.extension() == ".json");
}

std::set<std::string> PartsOfSide(const DoorSelection& selection) {
  const SplitSide named = SplitSideOf(selection.split, selection.default_side);
  Require(!named.side.empty(), ErrorCode::kInvalidArgument,
          "split \"" + selection.split + "\": which side? Write " + selection.split +
              ":train, :validation, :test or :unseen_categories");
  const Split split = ReadSplit(named.file);
  const auto sides = SidesOf(split);
  const auto found = sides.find(named.side);
  Require(found != sides.end(), ErrorCode::kInvalidArgument,
          "split \"" + selection.split + "\": unknown side \"" + named.side +
              "\"; allowed are train, validation, test, unseen_categories");
  return {found->second->begin(), found->second->end()};
}

/// A door before its meshes are known. Without an entry in an index it has names alone, for a door
/// with its meshes takes many times as long to read.
struct ListedDoor {
  fs::path folder;
  DoorIdentity identity;
  bool is_indexed = false;
};

ListedDoor NamesIn(const nlohmann::ordered_json& json, const fs::path& folder,
                   const std::string& path) {
  ListedDoor door{folder, {}, false};
  door.identity.id = IdOf(json, "id", path);
  const auto category = CategoryNamed(ValueOf<std::string>(json, "category", path));
  Require(category.has_value(), ErrorCode::kFormat, path + ": unknown category");
  door.identity.category = *category;
  const auto mechanism = MechanismNamed(ValueOf<std::string>(json, "mechanism", path));
  Require(mechanism.has_value(), ErrorCode::kFormat, path + ": unknown mechanism");
  door.identity.mechanism = *mechanism;
  door.identity.body.id = ValueOf<std::string>(MemberOf(json, "body", path), "id", path);
  door.identity.handle.id = ValueOf<std::string>(MemberOf(json, "handle", path), "id", path);
  return door;
}

ListedDoor List(const fs::path& folder, const DoorIndex& index) {
  const fs::path file = folder / "door.json";
  const std::string record = ReadFile(file, kMaxRecordBytes);
  if (index.size() > 0) {
    if (const DoorIdentity* found = index.Find(Sha256Hex(record))) return {folder, *found, true};
  }
  return NamesIn(ParseJson(record, file.string()), folder, file.string());
}

/// The doors that were found, and why others could not be read.
struct Listing {
  std::vector<ListedDoor> doors;
  std::vector<std::string> problems;
};

// Calls read(i) for each of `count` doors; gives what those that failed said.
std::vector<std::string> ReadEach(std::size_t count, int threads,
                                  const std::function<void(std::size_t)>& read) {
  std::vector<std::string> problems(count);
  ParallelFor(count, threads, [&](std::size_t i) {
    try {
      read(i);
    } catch (const Error& error) {
      problems[i] = error.what();
    }
  });
  std::erase(problems, "");
  return problems;
}

void RequireReadable(const std::vector<std::string>& problems) {
  constexpr std::size_t kMostNamed = 20;
  if (problems.empty()) return;
  std::string text =
      std::to_string(problems.size()) + " doors cannot be read (`doorforge validate` says more):";
  for (std::size_t i = 0; i < std::min(problems.size(), kMostNamed); ++i)
    text += "\n  " + problems[i];
  if (problems.size() > kMostNamed)
    text += "\n  and " + std::to_string(problems.size() - kMostNamed) + " more";
  throw Error(ErrorCode::kFormat, text);
}

Listing ListDoors(const std::vector<fs::path>& folders, int threads) {
  const std::set<fs::path> found = FindDoors(folders);
  const std::vector<fs::path> paths(found.begin(), found.end());
  std::map<fs::path, DoorIndex> indices;
  for (const fs::path& path : paths) {
    const auto [place, is_new] = indices.try_emplace(path.parent_path());
    if (is_new) place->second = ReadDoorIndex(place->first);
  }
  Listing listing;
  listing.doors.resize(paths.size());
  listing.problems = ReadEach(paths.size(), threads, [&](std::size_t i) {
    listing.doors[i] = List(paths[i], indices.at(paths[i].parent_path()));
  });
  std::erase_if(listing.doors, [](const ListedDoor& door) { return door.folder.empty(); });
  return listing;
}

void KeepThoseOfSplit(const DoorSelection& selection, std::vector<ListedDoor>& doors) {
  const std::set<std::string> parts = PartsOfSide(selection);
  const std::size_t before = doors.size();
  std::erase_if(doors, [&](const ListedDoor& door) {
    return !parts.contains(door.identity.body.id) || !parts.contains(door.identity.handle.id);
  });
  if (doors.empty())
    throw Error(ErrorCode::kMissing,
                "none of the " + std::to_string(before) +
                    " doors has body and handle of the split \"" + selection.split +
                    "\"; compose doors of its parts (`doorforge catalog build`, `doorforge compose "
                    "--all`)");
}

using DoorCounts = std::map<Category, std::size_t>;

DoorCounts CountDoors(const std::vector<ListedDoor>& doors) {
  DoorCounts counts;
  for (const ListedDoor& door : doors) ++counts[door.identity.category];
  return counts;
}

std::vector<std::string> NotesOn(const DoorSelection& selection, const DoorCounts& all,
                                 const DoorCounts& meant) {
  std::vector<std::string> notes;
  for (const auto& [category, count] : all) {
    const std::string name = std::string(NameOf(category));
    const auto found = meant.find(category);
    if (found == meant.end()) {
      notes.push_back(name + ": none of its " + std::to_string(count) +
                      " doors has body and handle of " + selection.split);
    } else if (std::cmp_less(found->second, selection.per_category)) {
      notes.push_back(name + ": all of its " + std::to_string(found->second) + " doors, " +
                      std::to_string(selection.per_category) + " were asked for");
    }
  }
  return notes;
}

void SortById(std::vector<ListedDoor>& doors) {
  std::stable_sort(doors.begin(), doors.end(), [](const ListedDoor& a, const ListedDoor& b) {
    return a.identity.id < b.identity.id;
  });
}

// Takes and leaves them sorted by id.
void KeepSomeOfEachCategory(int most, std::vector<ListedDoor>& doors) {
  std::vector<DoorIdentity> identities;
  identities.reserve(doors.size());
  for (const ListedDoor& door : doors) identities.push_back(door.identity);
  std::vector<ListedDoor> drawn;
  for (const std::size_t door : DrawDoors(identities, static_cast<std::size_t>(most)))
    drawn.push_back(std::move(doors[door]));
  doors = std::move(drawn);
}

// Reads those without an entry in an index.
std::vector<std::string> IdentifyRest(std::vector<ListedDoor>& doors, int threads) {
  std::vector<ListedDoor*> rest;
  for (ListedDoor& door : doors) {
    if (!door.is_indexed) rest.push_back(&door);
  }
  std::optional<Progress> progress;
  if (rest.size() >= kManyDoors) progress.emplace("reading doors without an index", rest.size());
  DoorIdentifier identifier;
  return ReadEach(rest.size(), threads, [&](std::size_t i) {
    const std::string path = (rest[i]->folder / "door.json").string();
    rest[i]->identity = identifier.Identify(ReadJsonFile(path), rest[i]->folder);
    if (progress) progress->Advance();
  });
}

std::vector<FoundDoor> EachOnce(std::vector<ListedDoor> doors) {
  std::vector<FoundDoor> found;
  for (ListedDoor& door : doors) {
    if (!found.empty() && found.back().identity.id == door.identity.id) {
      Require(found.back().identity.sha256 == door.identity.sha256, ErrorCode::kInvalidArgument,
              "two different doors have the id \"" + door.identity.id + "\": " +
                  found.back().folder.string() + " and " + door.folder.string() + "; rename one");
      continue;
    }
    found.push_back({std::move(door.identity), std::move(door.folder), door.is_indexed});
  }
  return found;
}

}  // namespace

DatasetDoor DatasetDoorOf(const DoorIdentity& identity) {
  return {identity.id,
          identity.sha256,
          std::string(NameOf(identity.category)),
          std::string(NameOf(identity.mechanism)),
          identity.body,
          identity.handle,
          identity.license,
          ""};
}

DoorIdentity IdentityOf(const DatasetDoor& door) {
  const auto category = CategoryNamed(door.category);
  const auto mechanism = MechanismNamed(door.mechanism);
  if (!category || !mechanism)
    throw Error(ErrorCode::kFormat, "door " + door.id + ": unknown category or mechanism");
  return {.id = door.id,
          .category = *category,
          .mechanism = *mechanism,
          .body = door.body,
          .handle = door.handle,
          .sha256 = door.sha256,
          .license = door.license};
}

DoorSelection DoorSelectionOf(const std::vector<std::string>& words,
                              const std::string& default_side, const std::string& split) {
  DoorSelection selection{.folders = {}, .split = split, .default_side = default_side};
  for (const std::string& word : words) {
    if (!NamesASplit(word)) {
      selection.folders.emplace_back(word);
      continue;
    }
    Require(selection.split.empty(), ErrorCode::kInvalidArgument,
            "--doors " + word + ": a second split beside " + selection.split + "; give one");
    selection.split = word;
  }
  if (selection.folders.empty())
    throw Error(
        ErrorCode::kInvalidArgument,
        "--doors: " +
            (selection.split.empty() ? "" : "the split " + selection.split + " names parts; ") +
            "give a folder of composed doors as well, such as `--doors full:train doors`; "
            "`doorforge catalog build` and `doorforge compose --all` make them");
  return selection;
}

DoorSet FindDoorSet(const DoorSelection& selection, int threads) {
  Require(selection.per_category >= 0, ErrorCode::kInvalidArgument,
          "the number of doors of each category must be 0 or more");
  Listing listing = ListDoors(selection.folders, threads);
  std::vector<ListedDoor>& doors = listing.doors;
  if (doors.empty()) RequireReadable(listing.problems);
  DoorSet set;
  const DoorCounts all = CountDoors(doors);
  if (!selection.split.empty()) KeepThoseOfSplit(selection, doors);
  set.notes = NotesOn(selection, all, CountDoors(doors));
  SortById(doors);
  if (selection.per_category > 0) KeepSomeOfEachCategory(selection.per_category, doors);
  const std::vector<std::string> unread = IdentifyRest(doors, threads);
  listing.problems.insert(listing.problems.end(), unread.begin(), unread.end());
  RequireReadable(listing.problems);
  set.doors = EachOnce(std::move(doors));
  return set;
}

std::vector<FoundDoor> FindRecordedDoors(const DoorSelection& selection,
                                         const std::vector<DatasetDoor>& recorded, int threads) {
  Listing listing = ListDoors(selection.folders, threads);
  RequireReadable(listing.problems);
  std::vector<ListedDoor>& listed = listing.doors;
  if (!selection.split.empty()) KeepThoseOfSplit(selection, listed);
  std::map<std::string, fs::path> by_id;
  for (ListedDoor& door : listed) by_id[door.identity.id] = std::move(door.folder);
  std::vector<FoundDoor> doors;
  bool any = false;
  for (const DatasetDoor& door : recorded) {
    const auto found = by_id.find(door.id);
    any = any || found != by_id.end();
    doors.push_back({IdentityOf(door), found == by_id.end() ? fs::path() : found->second, false});
  }
  Require(any, ErrorCode::kInvalidArgument,
          "--doors: none of the dataset's doors is among the " + std::to_string(listed.size()) +
              " there" + (recorded.empty() ? "" : ", such as " + recorded[0].id));
  return doors;
}

std::shared_ptr<const DoorAsset> DoorCache::Kept(std::size_t door) {
  const std::scoped_lock lock(mutex_);
  const auto found = places_.find(door);
  if (found == places_.end()) return nullptr;
  found->second.taken_at = ++clock_;
  return found->second.door;
}

std::shared_ptr<const DoorAsset> DoorCache::Read(const FoundDoor& found) {
  if (found.folder.empty())
    throw Error(ErrorCode::kMissing,
                "door \"" + found.identity.id + "\": not in the folders of --doors");
  auto [door, identity] = identifier_.Read(found.folder);
  if (identity.sha256 != found.identity.sha256)
    throw Error(ErrorCode::kFormat,
                found.folder.string() +
                    ": the door is not what it was when it was listed or recorded; put it back as "
                    "it was, or collect anew in another folder");
  if (found.is_indexed && identity != found.identity)
    throw Error(ErrorCode::kFormat,
                found.folder.string() + ": the " + kDoorIndexFile +
                    " beside this door says what its door.json does not; remove that file, or "
                    "give the command of `doorforge compose` that made the doors again");
  return std::make_shared<const DoorAsset>(std::move(door));
}

IdentifiedDoor DoorCache::Take(std::size_t door) {
  const FoundDoor& found = doors_.at(door);
  if (auto kept = Kept(door)) return {std::move(kept), found.identity.sha256};
  auto read = Read(found);
  const std::scoped_lock lock(mutex_);
  if (places_.size() >= kMostKept)
    places_.erase(std::min_element(
        places_.begin(), places_.end(),
        [](const auto& a, const auto& b) { return a.second.taken_at < b.second.taken_at; }));
  places_[door] = {read, ++clock_};
  return {std::move(read), found.identity.sha256};
}

}  // namespace doorforge

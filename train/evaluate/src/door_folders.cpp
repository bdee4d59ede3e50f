// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/door_folders.h"

#include <algorithm>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/find_doors.h"
#include "doorforge/schemas/split.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::set<std::string> PartsOfSide(const std::string& split) {
  const std::size_t colon = split.rfind(':');
  const std::string name = split.substr(0, colon);
  const std::string side = colon == std::string::npos ? "test" : split.substr(colon + 1);
  const fs::path own = DataFolder() / "splits" / (name + ".yaml");
  const Split parts = ReadSplit(fs::exists(own) ? own : fs::path(name));
  const std::map<std::string, const std::vector<std::string>*> sides = {
      {"train", &parts.train},
      {"test", &parts.test},
      {"unseen_categories", &parts.unseen_categories}};
  const auto found = sides.find(side);
  Require(found != sides.end(), ErrorCode::kInvalidArgument,
          "split \"" + split + "\": unknown side \"" + side +
              "\"; allowed are train, test, unseen_categories");
  return {found->second->begin(), found->second->end()};
}

// A record's names alone: a door with its meshes takes a hundred times as long to read.
struct ListedDoor {
  fs::path folder;
  std::string id;
  std::string category;
  std::string body;
  std::string handle;
};

ListedDoor ListedDoorIn(const fs::path& folder) {
  const std::string path = (folder / "door.json").string();
  const nlohmann::ordered_json json = ReadJsonFile(path);
  return {folder, ValueOf<std::string>(json, "id", path),
          ValueOf<std::string>(json, "category", path),
          ValueOf<std::string>(MemberOf(json, "body", path), "id", path),
          ValueOf<std::string>(MemberOf(json, "handle", path), "id", path)};
}

std::vector<fs::path> EvenlyFrom(const std::vector<ListedDoor>& doors, int most) {
  std::vector<fs::path> chosen;
  const std::size_t count =
      most == 0 ? doors.size() : std::min(doors.size(), static_cast<std::size_t>(most));
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(doors[i * doors.size() / count].folder);
  return chosen;
}

std::vector<fs::path> Selected(const std::vector<fs::path>& folders,
                               const DoorSelection& selection) {
  std::set<std::string> parts;
  if (!selection.split.empty()) parts = PartsOfSide(selection.split);
  std::map<std::string, std::vector<ListedDoor>> by_category;
  for (const fs::path& folder : folders) {
    ListedDoor door = ListedDoorIn(folder);
    if (selection.split.empty() || (parts.contains(door.body) && parts.contains(door.handle)))
      by_category[door.category].push_back(std::move(door));
  }
  std::vector<fs::path> chosen;
  for (auto& [category, doors] : by_category) {
    std::sort(doors.begin(), doors.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    const auto some = EvenlyFrom(doors, selection.per_category);
    chosen.insert(chosen.end(), some.begin(), some.end());
  }
  if (chosen.empty())
    throw Error(ErrorCode::kMissing,
                "none of the " + std::to_string(folders.size()) +
                    " doors has body and handle of the split \"" + selection.split +
                    "\"; compose doors of its parts (`doorforge catalog build`, `doorforge compose "
                    "--all`)");
  return chosen;
}

}  // namespace

std::vector<DoorAsset> ReadDoors(const std::vector<std::string>& folders,
                                 const DoorSelection& selection) {
  Require(selection.per_category >= 0, ErrorCode::kInvalidArgument,
          "the number of doors of each category must be 0 or more");
  const std::set<fs::path> found = FindDoors({folders.begin(), folders.end()});
  std::vector<fs::path> paths(found.begin(), found.end());
  if (!selection.split.empty() || selection.per_category > 0) paths = Selected(paths, selection);
  std::vector<DoorAsset> doors;
  for (const fs::path& path : paths) doors.push_back(ReadDoor(path));
  std::stable_sort(doors.begin(), doors.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  for (std::size_t i = 1; i < doors.size(); ++i) {
    if (doors[i].id != doors[i - 1].id) continue;
    if (ContentHash(doors[i]) != ContentHash(doors[i - 1]))
      throw Error(ErrorCode::kInvalidArgument,
                  "two different doors have the id \"" + doors[i].id + "\"; rename one");
    doors.erase(doors.begin() + static_cast<std::ptrdiff_t>(i--));
  }
  return doors;
}

ReportDoor ReportDoorOf(const DoorAsset& door) {
  return {.id = door.id,
          .category = door.category,
          .mechanism = door.mechanism,
          .body = door.body,
          .handle = door.handle,
          .sha256 = ContentHash(door),
          .license = door.license};
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "subtask.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

const std::array<Subtask, 7>& Subtasks() {
  static const std::array<Subtask, 7> kSubtasks = {{
      {"LeverDoor", Category::kInterior, Mechanism::kLever},
      {"RoundDoor", Category::kInterior, Mechanism::kRound},
      {"Window", Category::kWindow, Mechanism::kLever},
      {"Car", Category::kCar, Mechanism::kFlap},
      {"Safe", Category::kSafe, Mechanism::kValve},
      {"Cabinet", Category::kStorageFurniture, Mechanism::kRound},
      {"Fridge", Category::kRefrigerator, Mechanism::kLever},
  }};
  return kSubtasks;
}

// ids of the release by their leading digits; windows share theirs with interior doors, but have
// mesh names of their own
struct IdRange {
  const char* prefix;
  std::size_t subtask;
};
constexpr std::array<IdRange, 8> kBodyIds = {{{"99611", 4},
                                              {"99613", 5},
                                              {"99614", 6},
                                              {"9965", 0},
                                              {"9966", 0},
                                              {"9967", 3},
                                              {"9968", 0},
                                              {"9969", 0}}};

std::vector<std::string> MeshNames(const UrdfModel& model) {
  std::vector<std::string> names;
  for (const UrdfLink& link : model.links) {
    for (const UrdfShape& shape : link.visuals) {
      if (const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry))
        names.push_back(fs::path(mesh->filename).stem().string());
    }
  }
  return names;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool HasHandleId(const std::vector<std::string>& names, const std::string& prefix) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name.starts_with(prefix); });
}

// round handles of the release are numbered 9962xxx and 99616xx
Subtask InteriorBy(const std::vector<std::string>& meshes) {
  return Subtasks()[HasHandleId(meshes, "9962") || HasHandleId(meshes, "99616") ? 1 : 0];
}

std::optional<Subtask> ByContent(const std::string& object, const UrdfModel& model) {
  const std::vector<std::string> meshes = MeshNames(model);
  if (Contains(meshes, "car-door")) return Subtasks()[3];
  if (Contains(meshes, "untitled1")) return Subtasks()[2];
  for (const IdRange& range : kBodyIds) {
    if (object.size() != 14 || !object.starts_with(range.prefix)) continue;
    return range.subtask == 0 ? InteriorBy(meshes) : Subtasks()[range.subtask];
  }
  return std::nullopt;
}

Subtask ByCategory(const std::string& name, const UrdfModel& model) {
  const std::optional<Category> category = CategoryNamed(name);
  if (!category)
    throw Error(ErrorCode::kInvalidArgument,
                "--category: unknown category \"" + name +
                    "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
  if (*category == Category::kInterior) return InteriorBy(MeshNames(model));
  return *std::find_if(Subtasks().begin(), Subtasks().end(),
                       [&](const Subtask& s) { return s.category == *category; });
}

}  // namespace

std::string ObjectNameOf(const fs::path& folder) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  return (absolute.has_filename() ? absolute : absolute.parent_path()).filename().string();
}

Subtask SubtaskOf(const fs::path& folder, const UrdfModel& model, const std::string& category) {
  if (!category.empty()) return ByCategory(category, model);
  const std::string parent =
      (fs::absolute(folder).lexically_normal() / "x").parent_path().parent_path().filename();
  for (const Subtask& subtask : Subtasks()) {
    if (subtask.name == parent) return subtask;
  }
  if (const std::optional<Subtask> found = ByContent(ObjectNameOf(folder), model)) return *found;
  throw Error(ErrorCode::kInvalidArgument,
              folder.string() +
                  ": neither its folder nor its meshes tell what kind of door it is; "
                  "pass --category");
}

}  // namespace doorforge::internal

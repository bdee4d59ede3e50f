// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/compose/shared_doors.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/importers/author_place.h"
#include "doorforge/schemas/door_index.h"

#include "part_store.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct PreparedParts {
  std::vector<PreparedPart> parts;
  std::vector<std::string> names;  ///< Each is as PartStore has it.
  std::vector<fs::path> folders;   ///< Each is empty for a part of the catalogue.
  std::set<std::string> left_out;  ///< Folder names, or ids, of those that were not prepared.
  std::size_t damaged = 0;         ///< So many of those left out were left out by no rule.
};

/// What came of one part of many.
struct Preparation {
  std::optional<PreparedPart> part;
  bool is_wanted = true;  ///< False: it is of another category than the doors that are asked for.
  std::string problem;
  bool damaged = false;
};

// Whatever is wrong with one part, the others go on.
Preparation Prepare(const PartStore& store, const std::string& name, const ComposeRun& run,
                    const ComposeConfig& config) {
  Preparation prepared;
  try {
    const WorkBudget budget(name, run.max_seconds);
    Part part = store.Load(name);
    prepared.is_wanted = run.category.empty() || NameOf(part.category) == run.category;
    if (prepared.is_wanted) prepared.part.emplace(std::move(part), config);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kInvalidConfig) throw;  // nothing of the part
    prepared.problem = error.what();
    // kInvalidArgument is a rule: no door has this part
    prepared.damaged = error.code() != ErrorCode::kInvalidArgument;
  } catch (const std::exception&) {
    prepared.problem = CurrentProblem(name);
    prepared.damaged = true;
  }
  return prepared;
}

PreparedParts PrepareParts(const PartStore& store, const std::vector<std::string>& names,
                           const ComposeRequest& request, const ComposeRun& run) {
  std::vector<Preparation> prepared(names.size());
  Progress progress("preparing parts", names.size());
  ParallelFor(names.size(), run.threads, [&](std::size_t i) {
    prepared[i] = Prepare(store, names[i], run, request.door);
    progress.Advance();
  });
  PreparedParts parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!prepared[i].part) {
      if (prepared[i].is_wanted) run.note(names[i] + ": left out: " + prepared[i].problem);
      parts.left_out.insert(fs::path(names[i]).filename().string());
      parts.damaged += prepared[i].damaged ? 1 : 0;
      continue;
    }
    parts.parts.push_back(std::move(*prepared[i].part));
    parts.names.push_back(names[i]);
    parts.folders.push_back(store.FolderOf(names[i]));
  }
  return parts;
}

void SetAuthorPlaces(const PreparedParts& parts, std::vector<PartPair>& pairs) {
  std::map<std::size_t, AuthorPlaces> places;  // by body
  for (PartPair& pair : pairs) {
    if (parts.folders[pair.body].empty()) continue;
    const auto [known, added] = places.try_emplace(pair.body);
    if (added) known->second = ReadAuthorPlaces(parts.folders[pair.body]);
    const auto place = known->second.find(parts.parts[pair.handle].source_sha256());
    if (place != known->second.end()) pair.body_from_handle = place->second;
  }
}

std::map<std::string, std::size_t> PlacesById(const std::vector<PreparedPart>& parts) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!places.emplace(parts[i].id(), i).second)
      throw Error(ErrorCode::kInvalidArgument,
                  "two parts have the id \"" + parts[i].id() + "\"; rename one");
  }
  return places;
}

std::vector<PartPair> ImportedPairs(const fs::path& folder, const PreparedParts& prepared) {
  const std::map<std::string, std::size_t> places = PlacesById(prepared.parts);
  const std::string file = (folder / "import.json").string();
  const auto json = ReadJsonFile(file);
  RequireSchema(json, "doorforge.import", 1, file);
  constexpr auto kLeftOut = std::numeric_limits<std::size_t>::max();
  const auto place = [&](const nlohmann::ordered_json& object, const char* role) {
    const auto id = ValueOf<std::string>(object, role, file);
    const auto found = places.find(id);
    if (found == places.end() && prepared.left_out.contains(id)) return kLeftOut;
    if (found == places.end())
      throw Error(ErrorCode::kMissing, "part \"" + id + "\" of import.json is not among --parts");
    return found->second;
  };
  std::vector<PartPair> pairs;
  for (const auto& object : MemberOf(json, "objects", file)) {
    // what came without a handle, or without a leaf, is half a door
    const bool whole = !ValueOf<std::string>(object, "body", file).empty() &&
                       !ValueOf<std::string>(object, "handle", file).empty();
    if (!whole || ValueOf<std::string>(object, "outcome", file) != "imported") continue;
    const PartPair pair{place(object, "body"), place(object, "handle")};
    if (pair.body != kLeftOut && pair.handle != kLeftOut) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<PartPair> MatchingPairs(const std::vector<PreparedPart>& parts) {
  PlacesById(parts);
  std::vector<PartPair> pairs;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (parts[i].role() == PartRole::kBody && parts[k].role() == PartRole::kHandle &&
          parts[i].category() == parts[k].category())
        pairs.push_back({i, k});
    }
  }
  return pairs;
}

std::vector<ComposedDoor> WriteStandalone(const SharedDoorPlan& plan, const PartStore& store,
                                          const std::vector<std::string>& names,
                                          const ComposeRun& run) {
  // the parts as they were made; prepared ones are changed already
  std::map<std::string, Part> made;
  for (const std::string& name : names) {
    Part part = store.Load(name);
    made.emplace(part.id, std::move(part));
  }
  std::vector<ComposedDoor> doors(plan.pairs.size());
  Progress progress("composing", plan.pairs.size());
  ParallelFor(plan.pairs.size(), plan.threads, [&](std::size_t i) {
    const Part& body = made.at(plan.parts[plan.pairs[i].body].id());
    const Part& handle = made.at(plan.parts[plan.pairs[i].handle].id());
    doors[i].id = NameOfPair(body.id, handle.id, plan.config);
    try {
      if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
      const WorkBudget budget(doors[i].id, run.max_seconds);
      const DoorAsset door = ComposeDoor(body, handle, plan.config, plan.pairs[i].body_from_handle);
      doors[i].id = door.id;
      WriteDoorFolder(door, OutputBelow(run.out, door.id), plan.existing);
    } catch (const Error& error) {
      doors[i].problem = error.what();
    } catch (const std::exception&) {
      doors[i].problem = CurrentProblem(doors[i].id);
    }
    progress.Advance();
  });
  return doors;
}

std::vector<ComposedDoor> WriteShared(const SharedDoorPlan& plan, const fs::path& out) {
  WriteMeshPool(plan.parts, out, plan.threads);
  Progress progress("composing", plan.pairs.size());
  std::vector<ComposedDoor> doors;
  for (SharedDoorOutcome& outcome :
       WriteSharedDoors(plan, out, [&](std::size_t count) { progress.Advance(count); }))
    doors.push_back({std::move(outcome.id), std::move(outcome.problem), outcome.kept});
  return doors;
}

void RefuseToImport(const PartStore& store, const std::string& name) {
  if (store.IsToImport(name))
    throw Error(ErrorCode::kInvalidArgument,
                name + ": is no part; for many doors make it one first with `doorforge import`");
}

}  // namespace

bool MeansManyDoors(const ComposeRun& run, const ComposeRequest& request) {
  return run.pairs != PairChoice::kNamed || IsGlob(request.body) || IsGlob(request.handle);
}

ComposedDoors ComposeManyDoors(const ComposeRun& run, const ComposeRequest& request) {
  RequireWritable(run.out);
  const PartStore store(run.parts);
  RefuseToImport(store, request.body);
  RefuseToImport(store, request.handle);
  const FolderLock lock(run.out, "doorforge compose", Writers::kOne);
  std::vector<std::string> names;
  if (request.body.empty() || run.pairs != PairChoice::kNamed) {
    names = store.All();
  } else {
    names = store.Matching(request.body, PartRole::kBody);
    for (std::string& name : store.Matching(request.handle, PartRole::kHandle))
      names.push_back(std::move(name));
  }
  const PreparedParts prepared = PrepareParts(store, names, request, run);
  const std::vector<PreparedPart>& parts = prepared.parts;
  std::vector<PartPair> pairs = run.pairs == PairChoice::kAsImported
                                    ? ImportedPairs(run.parts, prepared)
                                    : MatchingPairs(parts);
  if (pairs.empty())
    throw Error(ErrorCode::kMissing, "compose: no body and handle of one category among the parts");
  SetAuthorPlaces(prepared, pairs);
  const SharedDoorPlan plan{parts, pairs, request.door, run.existing, run.threads};
  ComposedDoors composed;
  composed.damaged_parts = prepared.damaged;
  composed.doors = run.standalone ? WriteStandalone(plan, store, prepared.names, run)
                                  : WriteShared(plan, run.out);
  WriteJsonFile(run.out / "compose.json", ToJson(request));
  // readers of many doors start in a second with it, see docs/design/door-index.md
  if (StopRequested() == 0) WriteDoorIndex(run.out, run.threads);
  return composed;
}

nlohmann::ordered_json ComposedToJson(std::span<const ComposedDoor> doors) {
  auto list = nlohmann::ordered_json::array();
  for (const ComposedDoor& door : doors)
    list.push_back({{"id", door.id},
                    {"composed", door.problem.empty()},
                    {"kept", door.kept},
                    {"message", door.problem}});
  return {{"schema", "doorforge.compose"}, {"schema_version", 1}, {"doors", list}};
}

std::string ComposedText(std::span<const ComposedDoor> doors, const fs::path& out) {
  const auto failed = static_cast<std::size_t>(
      std::ranges::count_if(doors, [](const ComposedDoor& door) { return !door.problem.empty(); }));
  const auto kept = static_cast<std::size_t>(std::ranges::count(doors, true, &ComposedDoor::kept));
  const auto also = [](std::size_t count, const char* what) {
    return count == 0 ? std::string() : ", " + std::to_string(count) + what;
  };
  const std::size_t composed = doors.size() - failed;
  return std::to_string(composed) + (composed == 1 ? " door" : " doors") + " composed in " +
         out.string() + also(kept, " of them there already") + also(failed, " not") + "\n";
}

std::vector<std::string> ProblemsOf(std::span<const ComposedDoor> doors) {
  std::vector<std::string> problems;
  for (const ComposedDoor& door : doors) {
    if (!door.problem.empty()) problems.push_back(door.id + ": " + door.problem);
  }
  return problems;
}

}  // namespace doorforge

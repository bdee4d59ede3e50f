// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fnmatch.h>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/compose/compose.h"
#include "doorforge/compose/shared_doors.h"
#include "doorforge/core/committed_file.h"
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
#include "doorforge/mesh/work_budget.h"
#include "doorforge/schemas/door_index.h"
#include "doorforge/validate/validate_door.h"

#include "mesh_options.h"
#include "own_part.h"
#include "validate_verb.h"
#ifdef DOORFORGE_WITH_PREVIEW
#include "preview_verb.h"
#endif
#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

/// What --config and --set hold: everything that decides the doors.
struct ComposeRequest {
  std::string body = {};           ///< Id, folder or glob.
  std::string handle = {};         ///< The same.
  std::string category = {};       ///< Of a door whose body and handle are both to be imported.
  LooseMeshConfig body_mesh = {};  ///< How to read a body that is a mesh file.
  LooseMeshConfig handle_mesh = {};
  ComposeConfig door = {};

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("body", self.body);
    visit("handle", self.handle);
    visit("category", self.category);
    visit("body_mesh", self.body_mesh);
    visit("handle_mesh", self.handle_mesh);
    ComposeConfig::VisitFields(self.door, visit);
  }
};

struct Options {
  std::string body;
  std::string handle;
  std::string out;
  std::string parts;
  std::string category;
  std::string config;
  std::string place;
  std::vector<std::string> settings;
  LooseMeshConfig body_mesh = UnsetMeshOptions();
  LooseMeshConfig handle_mesh = UnsetMeshOptions();
  int threads = 0;
  double max_seconds = kObjectSeconds;
  bool all = false;
  bool as_imported = false;
  bool standalone = false;
  bool preview = false;
  bool validate = false;
  bool overwrite = false;
  bool json = false;
  bool quiet = false;
  bool rules = false;
};

void AddOptions(CLI::App& app, Options& options) {
  app.add_option("--body", options.body,
                 "id in the catalogue or in --parts, a part's folder, a glob of either, or what "
                 "`doorforge import` reads, such as a mesh file");
  app.add_option("--handle", options.handle, "the same");
  app.add_option("--out", options.out, "folder of the door; of the doors where there may be many");
  app.add_flag("--all", options.all, "every body with every handle of its category");
  app.add_flag("--as-imported", options.as_imported,
               "with --parts: the pairs that the imported objects were composed of");
  app.add_option("--parts", options.parts, "folder of parts; the catalogue if left out");
  app.add_option("--category", options.category,
                 "with many doors: only this category; of a door whose body and handle are both "
                 "imported on the way");
  AddHandleMeshOptions(app, "handle-", options.handle_mesh);
  AddMeshOptions(app, "handle-", options.handle_mesh);
  AddBodyMeshOptions(app, "body-", options.body_mesh);
  AddMeshOptions(app, "body-", options.body_mesh);
  app.add_option(
         "--place", options.place,
         "seat: the body's mount, the handle's back on the leaf; plane: the same with the "
         "handle's own plane of mounting; author: as on the object that both were imported from; "
         "axis: about the same axis, on the leaf; auto: axis for parts of one object, plane with "
         "--handle-mount, else seat")
      ->check(CLI::IsMember({"auto", "seat", "plane", "axis", "author"}));
  app.add_option("--config", options.config, "YAML file with body, handle and all settings");
  AddSettings(app, options.settings, "overrides one setting");
  app.add_flag("--standalone", options.standalone,
               "many doors: each with its own copy of the meshes");
  app.add_flag("--validate", options.validate,
               "one door: validate and simulate it, write validation.json; always with imported "
               "parts");
#ifdef DOORFORGE_WITH_PREVIEW
  app.add_flag("--preview", options.preview, "one door: write its picture thumb.png");
#endif
  app.add_option("--threads", options.threads, "0: all processors; no byte depends on it");
  AddMaxSeconds(app, options.max_seconds);
  app.add_flag("--overwrite", options.overwrite, "replace doors that are there already");
  app.add_flag("--json", options.json, "print one JSON document");
  app.add_flag("--quiet", options.quiet, "print nothing but errors");
  app.add_flag("--rules", options.rules, "list the rules of pairs and the presets, and end");
  app.footer(
      "Many doors share the meshes of their parts in OUT/pool; a door alone, or --standalone, has\n"
      "its own. A run that was ended goes on where it was when it is given again.\n"
      "examples:\n"
      "  doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out doors/a\n"
      "  doorforge compose --body interior_flush_01 --handle my_lever.stl --handle-mechanism lever "
      "\\\n"
      "      --handle-up y --handle-front z --out doors/mine --preview\n"
      "  doorforge compose --body 'interior_*_panel_*' --handle 'interior_lever*' --out doors \\\n"
      "      --set hinge_side=right\n"
      "  doorforge compose --all --category interior --out doors");
}

void CheckOptions(const Options& options) {
  const auto fail = [](const std::string& why) {
    throw Error(ErrorCode::kInvalidArgument, why + "; see `doorforge compose --help`");
  };
  if (options.out.empty()) fail("--out is required");
  if (options.all && options.as_imported) fail("--all and --as-imported exclude each other");
  if ((options.all || options.as_imported) && !(options.body.empty() && options.handle.empty()))
    fail("--all and --as-imported take no --body and --handle");
  if (options.as_imported && options.parts.empty()) fail("--as-imported needs --parts");
  if (!options.category.empty() && !CategoryNamed(options.category))
    fail("--category: unknown category \"" + options.category +
         "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
}

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Composes doors: a body and a handle of one category.", "doorforge compose");
  AddOptions(app, options);
  ParseVerb(app, argc, argv);
  if (!options.rules) CheckOptions(options);
  return options;
}

ComposeRequest RequestOf(const Options& options) {
  auto request = LoadConfig<ComposeRequest>(options.config, options.settings);
  if (!options.body.empty()) request.body = options.body;
  if (!options.handle.empty()) request.handle = options.handle;
  if (!options.place.empty()) request.door.place = options.place;
  if (!options.category.empty()) request.category = options.category;
  OverrideMesh(request.body_mesh, options.body_mesh);
  OverrideMesh(request.handle_mesh, options.handle_mesh);
  if (options.all || options.as_imported) return request;
  if (request.body.empty() || request.handle.empty())
    throw Error(
        ErrorCode::kInvalidArgument,
        (options.config.empty() ? "" : options.config + " names no pair of parts: ") +
            "--body and --handle (or both in --config), --all or --as-imported is required; "
            "see `doorforge compose --help`");
  return request;
}

bool IsGlob(const std::string& name) { return name.find_first_of("*?[") != std::string::npos; }

// False also for what can be no path, such as a name that is too long.
bool IsThere(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool IsPartFolder(const fs::path& folder) { return IsThere(folder / "part.json"); }

/// Where parts come from: the catalogue, or a folder of parts.
class PartStore {
 public:
  explicit PartStore(const std::string& folder) : folder_(folder) {
    if (folder.empty()) {
      catalogue_ = ListCatalogue(DataFolder());
      return;
    }
    if (!fs::is_directory(folder))
      throw Error(ErrorCode::kMissing, folder + ": no such folder of parts");
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (IsPartFolder(entry.path())) folders_.insert(entry.path());
    }
  }

  /// Names of all parts, in order.
  std::vector<std::string> All() const {
    std::vector<std::string> names;
    for (const CatalogueEntry& entry : catalogue_) names.push_back(entry.id);
    for (const fs::path& folder : folders_) names.push_back(folder.string());
    return names;
  }

  /// Names that an id, a folder or a glob stands for; at least one.
  std::vector<std::string> Matching(const std::string& wanted, PartRole role) const {
    if (!IsGlob(wanted)) return {wanted};
    std::vector<std::string> names;
    for (const CatalogueEntry& entry : catalogue_) {
      if (entry.role == role && Matches(wanted, entry.id)) names.push_back(entry.id);
    }
    for (const fs::path& folder : folders_) {
      if (Matches(wanted, folder.filename().string())) names.push_back(folder.string());
    }
    for (const fs::path& folder : FoldersLike(wanted)) names.push_back(folder.string());
    if (names.empty())
      throw Error(ErrorCode::kMissing, "no part is called like \"" + wanted +
                                           "\"; `doorforge catalog list` shows the catalogue");
    return names;
  }

  /// Gives the folder of a part in files; it is empty for one of the catalogue.
  fs::path FolderOf(const std::string& name) const {
    if (IsPartFolder(name)) return name;
    const bool in_store = !folder_.empty() && name.find('/') == std::string::npos;
    return in_store && IsPartFolder(folder_ / name) ? folder_ / name : fs::path();
  }

  /// Whether it is neither a part nor the name of one, but a file or folder to import.
  bool IsToImport(const std::string& name) const {
    if (!FolderOf(name).empty() || IsGlob(name)) return false;
    return IsThere(name) || fs::path(name).has_extension();
  }

  Part Load(const std::string& name) const {
    if (const fs::path folder = FolderOf(name); !folder.empty()) return ReadPart(folder);
    if (name.find('/') != std::string::npos || IsThere(name))
      throw Error(ErrorCode::kMissing, name +
                                           ": no part.json there; `doorforge import` and "
                                           "`doorforge catalog build` write parts");
    return catalogue_.empty() ? BuildCataloguePart(DataFolder(), name)
                              : BuildCataloguePart(FindCatalogueEntry(catalogue_, name));
  }

 private:
  static bool Matches(const std::string& glob, const std::string& name) {
    return ::fnmatch(glob.c_str(), name.c_str(), 0) == 0;
  }

  // folders of parts whose path is like the glob; only its last component may hold wildcards
  static std::set<fs::path> FoldersLike(const std::string& glob) {
    std::set<fs::path> folders;
    const fs::path path(glob);
    if (!path.has_parent_path() || !fs::is_directory(path.parent_path())) return folders;
    for (const auto& entry : fs::directory_iterator(path.parent_path())) {
      if (Matches(path.filename().string(), entry.path().filename().string()) &&
          IsPartFolder(entry.path()))
        folders.insert(entry.path());
    }
    return folders;
  }

  fs::path folder_;
  std::vector<CatalogueEntry> catalogue_;
  std::set<fs::path> folders_;
};

struct Door {
  std::string id;
  std::string problem;
  bool kept = false;
};

nlohmann::ordered_json ReportOf(const std::vector<Door>& doors) {
  auto list = nlohmann::ordered_json::array();
  for (const Door& door : doors)
    list.push_back({{"id", door.id},
                    {"composed", door.problem.empty()},
                    {"kept", door.kept},
                    {"message", door.problem}});
  return {{"schema", "doorforge.compose"}, {"schema_version", 1}, {"doors", list}};
}

int Finish(const std::vector<Door>& doors, const Options& options) {
  std::size_t failed = 0;
  std::size_t kept = 0;
  for (const Door& door : doors) {
    kept += door.kept ? 1 : 0;
    if (door.problem.empty()) continue;
    ++failed;
    std::fprintf(stderr, "doorforge: %s: %s\n", door.id.c_str(), door.problem.c_str());
  }
  if (options.json)
    std::cout << JsonText(ReportOf(doors), 2) << '\n';
  else if (!options.quiet)
    std::printf("%s composed in %s%s%s\n", Counted(doors.size() - failed, "door").c_str(),
                options.out.c_str(),
                kept == 0 ? "" : (", " + std::to_string(kept) + " of them there already").c_str(),
                failed == 0 ? "" : (", " + std::to_string(failed) + " not").c_str());
  if (const int signal = StopRequested()) return 128 + signal;
  return failed == 0 ? 0 : 1;
}

Existing OnExisting(const Options& options) {
  return options.overwrite ? Existing::kReplace : Existing::kRefuse;
}

// the settings that made the doors, in a form that --config reads
void WriteRequest(const ComposeRequest& request, const fs::path& folder) {
  WriteJsonFile(folder / "compose.json", ToJson(request));
}

struct PreparedParts {
  std::vector<PreparedPart> parts;
  std::vector<std::string> names;  ///< Of each, as PartStore has them.
  std::vector<fs::path> folders;   ///< Of each; empty for those of the catalogue.
  std::set<std::string> left_out;  ///< Folder names, or ids, of those that could not be prepared.
  std::size_t damaged = 0;         ///< Of those left out: parts that no rule left out.
};

/// What came of one part of many.
struct Preparation {
  std::optional<PreparedPart> part;
  std::string problem;
  bool damaged = false;
};

// Whatever is wrong with one part, the others go on.
Preparation Prepare(const PartStore& store, const std::string& name, const Options& options,
                    const ComposeConfig& config) {
  Preparation prepared;
  try {
    const WorkBudget budget(name, options.max_seconds);
    prepared.part.emplace(store.Load(name), config);
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
                           const ComposeRequest& request, const Options& options) {
  std::vector<Preparation> prepared(names.size());
  Progress progress("preparing parts", names.size());
  ParallelFor(names.size(), options.threads, [&](std::size_t i) {
    prepared[i] = Prepare(store, names[i], options, request.door);
    progress.Advance();
  });
  PreparedParts parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!prepared[i].part) {
      std::fprintf(stderr, "doorforge: %s: left out: %s\n", names[i].c_str(),
                   prepared[i].problem.c_str());
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

// nothing for parts of different objects
std::optional<RigidTransform> PlaceIn(const AuthorPlaces& places, const std::string& handle) {
  const auto found = places.find(handle);
  return found == places.end() ? std::nullopt : std::optional(found->second);
}

void SetAuthorPlaces(const PreparedParts& parts, std::vector<PartPair>& pairs) {
  std::map<std::size_t, AuthorPlaces> places;  // by body
  for (PartPair& pair : pairs) {
    if (parts.folders[pair.body].empty()) continue;
    const auto [known, added] = places.try_emplace(pair.body);
    if (added) known->second = ReadAuthorPlaces(parts.folders[pair.body]);
    pair.body_from_handle = PlaceIn(known->second, parts.parts[pair.handle].source_sha256());
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

std::vector<Door> WriteStandalone(const SharedDoorPlan& plan, const PartStore& store,
                                  const std::vector<std::string>& names, const Options& options) {
  // the parts as they were made; prepared ones are changed already
  std::map<std::string, Part> made;
  for (const std::string& name : names) {
    Part part = store.Load(name);
    made.emplace(part.id, std::move(part));
  }
  std::vector<Door> doors(plan.pairs.size());
  Progress progress("composing", plan.pairs.size());
  ParallelFor(plan.pairs.size(), plan.threads, [&](std::size_t i) {
    const Part& body = made.at(plan.parts[plan.pairs[i].body].id());
    const Part& handle = made.at(plan.parts[plan.pairs[i].handle].id());
    doors[i].id = body.id + "__" + handle.id;
    try {
      if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
      const WorkBudget budget(doors[i].id, options.max_seconds);
      const DoorAsset door = ComposeDoor(body, handle, plan.config, plan.pairs[i].body_from_handle);
      doors[i].id = door.id;
      WriteDoorFolder(door, OutputBelow(options.out, door.id), plan.existing);
    } catch (const Error& error) {
      doors[i].problem = error.what();
    } catch (const std::exception&) {
      doors[i].problem = CurrentProblem(doors[i].id);
    }
    progress.Advance();
  });
  return doors;
}

std::vector<Door> WriteShared(const SharedDoorPlan& plan, const fs::path& out) {
  WriteMeshPool(plan.parts, out, plan.threads);
  Progress progress("composing", plan.pairs.size());
  std::vector<Door> doors;
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

// Readers of many doors start in a second with it, see docs/design/door-index.md.
void IndexDoors(const Options& options) { WriteDoorIndex(options.out, options.threads); }

int ComposeMany(const Options& options, const ComposeRequest& request) {
  RequireWritable(options.out);
  const PartStore store(options.parts);
  RefuseToImport(store, request.body);
  RefuseToImport(store, request.handle);
  const FolderLock lock(options.out, "doorforge compose", Writers::kOne);
  std::vector<std::string> names;
  if (request.body.empty() || options.all || options.as_imported) {
    names = store.All();
  } else {
    names = store.Matching(request.body, PartRole::kBody);
    for (std::string& name : store.Matching(request.handle, PartRole::kHandle))
      names.push_back(std::move(name));
  }
  const PreparedParts prepared = PrepareParts(store, names, request, options);
  const std::vector<PreparedPart>& parts = prepared.parts;
  std::vector<PartPair> pairs =
      options.as_imported ? ImportedPairs(options.parts, prepared) : MatchingPairs(parts);
  if (!options.category.empty())
    std::erase_if(pairs, [&](const PartPair& pair) {
      return NameOf(parts[pair.body].category()) != options.category;
    });
  if (pairs.empty())
    throw Error(ErrorCode::kMissing, "compose: no body and handle of one category among the parts");
  SetAuthorPlaces(prepared, pairs);
  const SharedDoorPlan plan{parts, pairs, request.door, OnExisting(options), options.threads};
  const std::vector<Door> doors = options.standalone
                                      ? WriteStandalone(plan, store, prepared.names, options)
                                      : WriteShared(plan, options.out);
  WriteRequest(request, options.out);
  if (StopRequested() == 0) IndexDoors(options);
  const int code = Finish(doors, options);
  return code == 0 && prepared.damaged > 0 ? 1 : code;
}

/// One door on its way, with what was imported for it.
class OneDoor {
 public:
  OneDoor(const Options& options, ComposeRequest request)
      : options_(options), request_(std::move(request)), store_(options.parts) {}

  int Run() {
    // refuses what is there already before anything is imported
    { const StagedFolder probe(options_.out, kDoorFolder, OnExisting(options_)); }
    LoadParts();
    const fs::path body_folder = store_.FolderOf(request_.body);
    const std::optional<RigidTransform> authored =
        body_folder.empty() ? std::nullopt
                            : PlaceIn(ReadAuthorPlaces(body_folder), handle_->source_sha256);
    // who says where the leaf lies in the file is believed
    if (own_handle_ && !request_.handle_mesh.mount.empty() && request_.door.place == "auto")
      request_.door.place = "plane";
    const WorkBudget budget(options_.out, options_.max_seconds);
    const DoorAsset door = ComposeDoor(*body_, *handle_, request_.door, authored);
    WriteDoorFolder(door, options_.out, OnExisting(options_));
    WriteRequest(request_, options_.out);
    // beside the door, for other doors
    if (own_body_) own_body_->MoveTo(fs::path(options_.out) / "body");
    if (own_handle_) own_handle_->MoveTo(fs::path(options_.out) / "handle");
    const int code = Finish({{door.id, "", false}}, options_);
    return std::max(code, Check());
  }

 private:
  void LoadParts() {
    const bool own_body = store_.IsToImport(request_.body);
    const bool own_handle = store_.IsToImport(request_.handle);
    const auto load_body = [&] { return store_.Load(request_.body); };
    const auto load_handle = [&] { return store_.Load(request_.handle); };
    const auto import_body = [&] {
      return ImportOwn({request_.body, PartRole::kBody, CategoryFor(handle_), request_.body_mesh},
                       own_body_);
    };
    const auto import_handle = [&] {
      return ImportOwn(
          {request_.handle, PartRole::kHandle, CategoryFor(body_), request_.handle_mesh},
          own_handle_);
    };
    // what is imported takes its category from the other half
    if (!own_body) body_ = Named("body", options_.body, load_body);
    if (!own_handle) handle_ = Named("handle", options_.handle, load_handle);
    if (own_body) body_ = Named("body", options_.body, import_body);
    if (own_handle) handle_ = Named("handle", options_.handle, import_handle);
  }

  // A name that no option gave is the settings file's, and so is what is wrong with it.
  template <class Make>
  Part Named(const std::string& key, const std::string& option, Make&& make) const {
    try {
      return make();
    } catch (const Error& error) {
      if (!option.empty() || options_.config.empty()) throw;
      throw Error(error.code(), options_.config + ": " + key + ": " + error.what());
    }
  }

  // that of the other half
  Category CategoryFor(const std::optional<Part>& other) const {
    if (other) return other->category;
    if (const std::optional<Category> category = CategoryNamed(request_.category)) return *category;
    throw Error(ErrorCode::kInvalidArgument,
                "--category is required where body and handle are both to be imported");
  }

  Part ImportOwn(const OwnPartRequest& request, std::optional<OwnPart>& own) const {
    own.emplace(request, options_.out, options_.max_seconds);
    for (const std::string& note : own->notes())
      std::fprintf(stderr, "doorforge: %s: %s\n", own->part().id.c_str(), note.c_str());
    return own->part();
  }

  // of the door as it was written
  int Check() const {
    int errors = 0;
    if (options_.validate || own_body_ || own_handle_) {
      const std::unique_ptr<DoorValidator> openable = OpenableValidator();
      const ValidationReport report =
          openable ? openable->Door(options_.out) : ValidateDoor(options_.out);
      WriteJsonFile(fs::path(options_.out) / "validation.json", ToJson(std::span(&report, 1)));
      errors = report.errors;
      for (const Finding& finding : report.findings)
        std::fprintf(stderr, "doorforge: %s %s %s: measured %s; allowed %s; to fix: %s\n",
                     finding.code.c_str(), std::string(NameOf(finding.severity)).c_str(),
                     finding.where.c_str(), finding.measured.c_str(), finding.allowed.c_str(),
                     finding.fix.c_str());
      if (!options_.json && !options_.quiet)
        std::printf("validated: %s\n", CountedFindings(report.errors, report.warnings).c_str());
    }
#ifdef DOORFORGE_WITH_PREVIEW
    if (options_.preview) {
      const fs::path png = fs::path(options_.out) / "thumb.png";
      WritePreview(options_.out, png);
      if (!options_.json && !options_.quiet) std::printf("picture: %s\n", png.c_str());
    }
#endif
    return errors == 0 ? 0 : 1;
  }

  const Options& options_;
  ComposeRequest request_;
  PartStore store_;
  std::optional<Part> body_;
  std::optional<Part> handle_;
  std::optional<OwnPart> own_body_;
  std::optional<OwnPart> own_handle_;
};

int ListRules() {
  for (const ComposeRule& rule : ComposeRules())
    std::printf("%s %s\n", std::string(rule.code).c_str(), std::string(rule.text).c_str());
  const auto list = [](const char* key, std::span<const ComposePreset> presets) {
    for (const ComposePreset& preset : presets)
      std::printf("%s: %s  %s\n", key, std::string(preset.name).c_str(),
                  std::string(preset.source).c_str());
  };
  list("masses", MassPresets());
  list("joints", JointPresets());
  return 0;
}

}  // namespace

int RunComposeVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  if (options.rules) return ListRules();
  const ComposeRequest request = RequestOf(options);
  const bool many =
      options.all || options.as_imported || IsGlob(request.body) || IsGlob(request.handle);
  return NamingConfig(options.config, [&] {
    return many ? ComposeMany(options, request) : OneDoor(options, request).Run();
  });
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "compose_verb.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/core/config_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/door/catalogue.h"
#include "doorforge/door/compose.h"
#include "doorforge/door/export_urdf.h"

#include "verb_options.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string body;
  std::string handle;
  std::string out;
  std::string parts;
  std::string category;
  std::string config;
  std::vector<std::string> settings;
  int threads = 0;
  bool all = false;
  bool as_imported = false;
  bool overwrite = false;
  bool json = false;
  bool quiet = false;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Composes doors: a body and a handle of one category.", "doorforge compose");
  auto* body = app.add_option("--body", options.body, "id in the catalogue, or a part's folder");
  auto* handle =
      app.add_option("--handle", options.handle, "id in the catalogue, or a part's folder");
  body->needs(handle);
  handle->needs(body);
  app.add_option("--out", options.out, "folder of the door; of many doors with --all")->required();
  auto* all = app.add_flag("--all", options.all, "every body with every handle of its category");
  app.add_flag("--as-imported", options.as_imported,
               "with --parts: the pairs that the imported objects were composed of")
      ->excludes(all)
      ->excludes(body);
  all->excludes(body);
  app.add_option("--parts", options.parts, "folder of parts; the catalogue if left out");
  app.add_option("--category", options.category, "with --all: only this category");
  app.add_option("--config", options.config, "YAML file with the settings of compose");
  app.add_option("--set", options.settings, "a.b=c overrides one setting");
  app.add_option("--threads", options.threads, "0: all processors");
  app.add_flag("--overwrite", options.overwrite, "replace doors that are there already");
  app.add_flag("--json", options.json, "print one JSON document");
  app.add_flag("--quiet", options.quiet, "print nothing but errors");
  app.footer(
      "examples:\n"
      "  doorforge compose --body parts/udm-9965008 --handle parts/udm-9960001 --out doors/mine\n"
      "  doorforge compose --all --category interior --out doors");
  ParseVerb(app, argc, argv);
  if (options.body.empty() && !options.all && !options.as_imported)
    throw Error(ErrorCode::kInvalidArgument,
                "--body and --handle, --all or --as-imported is required; see `doorforge compose "
                "--help`");
  if (options.as_imported && options.parts.empty())
    throw Error(ErrorCode::kInvalidArgument, "--as-imported needs --parts");
  if (!options.category.empty() && !CategoryNamed(options.category))
    throw Error(ErrorCode::kInvalidArgument,
                "--category: unknown category \"" + options.category +
                    "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
  return options;
}

// an id of the catalogue, or a folder with part.json
Part LoadPart(const std::string& name) {
  if (fs::exists(fs::path(name) / "part.json")) return ReadPart(name);
  if (name.find('/') != std::string::npos || fs::exists(name))
    throw Error(ErrorCode::kMissing, name +
                                         ": no part.json there; `doorforge import` and "
                                         "`doorforge catalog build` write parts");
  return BuildCataloguePart(DataFolder(), name);
}

using Pair = std::pair<std::string, std::string>;

std::vector<Part> AllParts(const Options& options) {
  std::vector<Part> parts;
  if (options.parts.empty()) {
    for (const CatalogueEntry& entry : ListCatalogue(DataFolder()))
      parts.push_back(BuildCataloguePart(entry));
    return parts;
  }
  std::set<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(options.parts)) {
    if (fs::exists(entry.path() / "part.json")) folders.insert(entry.path());
  }
  for (const fs::path& folder : folders) parts.push_back(ReadPart(folder));
  return parts;
}

std::vector<Pair> ImportedPairs(const fs::path& folder) {
  const fs::path file = folder / "import.json";
  const auto json = ReadJsonFile(file);
  RequireSchema(json, "doorforge.import", 1, file.string());
  std::vector<Pair> pairs;
  for (const auto& object : MemberOf(json, "objects", file.string())) {
    if (ValueOf<std::string>(object, "outcome", file.string()) != "imported") continue;
    pairs.emplace_back(ValueOf<std::string>(object, "body", file.string()),
                       ValueOf<std::string>(object, "handle", file.string()));
  }
  return pairs;
}

std::vector<Pair> MatchingPairs(const std::vector<Part>& parts) {
  std::vector<Pair> pairs;
  for (const Part& body : parts) {
    for (const Part& handle : parts) {
      if (body.role == PartRole::kBody && handle.role == PartRole::kHandle &&
          body.category == handle.category)
        pairs.emplace_back(body.id, handle.id);
    }
  }
  return pairs;
}

const Part& PartNamed(const std::vector<Part>& parts, const std::string& id) {
  for (const Part& part : parts) {
    if (part.id == id) return part;
  }
  throw Error(ErrorCode::kMissing, "part \"" + id + "\" of import.json is not among --parts");
}

struct Door {
  std::string id;
  std::string problem;
};

nlohmann::ordered_json ToJson(const std::vector<Door>& doors) {
  auto list = nlohmann::ordered_json::array();
  for (const Door& door : doors)
    list.push_back(
        {{"id", door.id}, {"composed", door.problem.empty()}, {"message", door.problem}});
  return {{"schema", "doorforge.compose"}, {"schema_version", 1}, {"doors", list}};
}

int Finish(const std::vector<Door>& doors, const Options& options) {
  std::size_t failed = 0;
  for (const Door& door : doors) {
    if (door.problem.empty()) continue;
    ++failed;
    std::fprintf(stderr, "doorforge: %s: %s\n", door.id.c_str(), door.problem.c_str());
  }
  if (options.json)
    std::cout << ToJson(doors).dump(2) << '\n';
  else if (!options.quiet)
    std::printf("%zu doors composed in %s%s\n", doors.size() - failed, options.out.c_str(),
                failed == 0 ? "" : (", " + std::to_string(failed) + " not").c_str());
  if (const int signal = StopRequested()) return 128 + signal;
  return failed == 0 ? 0 : 1;
}

Existing OnExisting(const Options& options) {
  return options.overwrite ? Existing::kReplace : Existing::kRefuse;
}

int ComposeMany(const Options& options, const ComposeConfig& config) {
  const std::vector<Part> parts = AllParts(options);
  std::vector<Pair> pairs =
      options.as_imported ? ImportedPairs(options.parts) : MatchingPairs(parts);
  if (!options.category.empty())
    std::erase_if(pairs, [&](const Pair& pair) {
      return NameOf(PartNamed(parts, pair.first).category) != options.category;
    });
  if (pairs.empty())
    throw Error(ErrorCode::kMissing, "compose: no body and handle of one category among the parts");
  std::vector<Door> doors(pairs.size());
  Progress progress("composing", pairs.size());
  ParallelFor(pairs.size(), options.threads, [&](std::size_t i) {
    doors[i].id = pairs[i].first + "__" + pairs[i].second;
    try {
      if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
      const DoorAsset door =
          ComposeDoor(PartNamed(parts, pairs[i].first), PartNamed(parts, pairs[i].second), config);
      WriteDoorFolder(door, fs::path(options.out) / doors[i].id, OnExisting(options));
    } catch (const Error& error) {
      doors[i].problem = error.what();
    }
    progress.Advance();
  });
  return Finish(doors, options);
}

}  // namespace

int RunComposeVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  const auto config = LoadConfig<ComposeConfig>(options.config, options.settings);
  if (options.body.empty()) return ComposeMany(options, config);
  const DoorAsset door = ComposeDoor(LoadPart(options.body), LoadPart(options.handle), config);
  WriteDoorFolder(door, options.out, OnExisting(options));
  return Finish({{door.id, ""}}, options);
}

}  // namespace doorforge

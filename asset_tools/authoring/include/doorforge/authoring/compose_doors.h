// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/compose/compose.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/importers/foreign_object.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {

/// Everything that decides the doors; compose.json beside them holds it, and `--config` reads it.
struct ComposeRequest {
  /// An id of the catalogue or of the folder of parts, a part's folder, a glob of either, or a file
  /// or folder to import.
  std::string body = {};
  std::string handle = {};    ///< May be given in the same ways as the body.
  std::string category = {};  ///< The category applies if body and handle are both to be imported.
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

/// Which bodies are composed with which handles.
enum class PairChoice {
  kNamed,       ///< Those that the request names.
  kAll,         ///< Every body with every handle of its category.
  kAsImported,  ///< Those that came from one object, as import.json of the folder of parts says.
};

/// How doors are composed; of all this only `pairs` and `category` decide which doors come out.
struct ComposeRun {
  std::filesystem::path out;         ///< Folder of the door; of the doors where there may be many.
  std::filesystem::path parts = {};  ///< Folder of parts; empty: the catalogue.
  PairChoice pairs = PairChoice::kNamed;
  std::string category = {};  ///< Only doors of this category are composed; empty: those of any.
  /// Relative names of files to import are looked for here; empty: in the working directory. No
  /// byte of the door depends on it.
  std::filesystem::path files = {};
  bool standalone = false;  ///< Each of many doors has its own copy of the meshes.
  Existing existing = Existing::kRefuse;
  int threads = 0;                      ///< 0: all processors; no byte depends on it.
  double max_seconds = kObjectSeconds;  ///< Processor time that one object may take [s].
  /// Called with a line for people: what was left out, or assumed of what was imported.
  std::function<void(const std::string&)> note = [](const std::string&) {};
  /// What errors about the body begin with, such as "door.yaml: body"; empty: with its own name.
  std::string body_named_by = {};
  std::string handle_named_by = {};  ///< What errors about the handle begin with.
};

/// What came of a door.
struct ComposedDoor {
  std::string id;
  std::string problem;  ///< Why it could not be composed; empty if it could.
  bool kept = false;    ///< It was there already, as it would have been made.
};

struct ComposedDoors {
  std::vector<ComposedDoor> doors;
  std::size_t damaged_parts = 0;  ///< Left out for a fault, not by a rule.
  bool imported = false;          ///< A part of the door was imported on the way.
};

/// Whether there may be several doors, so that `out` is the folder of doors.
bool MeansManyDoors(const ComposeRun& run, const ComposeRequest& request);

/// Composes one door into `out`. What is imported on the way is put below it, as "body" and
/// "handle", for other doors.
///
/// @throws Error(kInvalidArgument) if the door is there already, a rule forbids the pair, or a part
///     to import takes its category from nowhere; Error(kMissing) if there is no such part; else as
///     ReadPart() and ImportObjects().
ComposedDoors ComposeOneDoor(const ComposeRun& run, const ComposeRequest& request);

/// Composes many doors, each into a folder below `out` with its id as name, and an index of them.
/// Whatever is wrong with one part or door, the others go on.
///
/// @throws Error(kMissing) if no body and handle of one category are among the parts;
///     Error(kInvalidArgument) if two parts have one id, or one is to be imported.
ComposedDoors ComposeManyDoors(const ComposeRun& run, const ComposeRequest& request);

/// {"schema": "doorforge.compose", "doors": [{"id", "composed", "kept", "message"}]}.
nlohmann::ordered_json ComposedToJson(std::span<const ComposedDoor> doors);

/// Says it for people: "2 doors composed in OUT, 1 of them there already, 1 not".
std::string ComposedText(std::span<const ComposedDoor> doors, const std::filesystem::path& out);

/// "<id>: <why>" of each door that could not be composed.
std::vector<std::string> ProblemsOf(std::span<const ComposedDoor> doors);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/importers/foreign_object.h"
#include "doorforge/mesh/work_budget.h"
#include "doorforge/parts/grasp.h"
#include "doorforge/parts/make_part.h"

namespace doorforge {

struct ImportConfig {
  ReadConfig read = {};
  MakePartConfig make = {};
  /// Keep what authors drew, with materials and textures, beside the closed meshes.
  bool visual = true;
  std::vector<std::string> only = {};  ///< Objects of other categories are left out; empty: none.
  int threads = 0;                     ///< 0: all processors. Does not change the result.
  /// Processor time to read an object, and to make a part, before it is given up [s].
  double max_seconds = kObjectSeconds;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("read", self.read);
    visit("make", self.make);
    visit("visual", self.visual);
    visit("only", self.only);
    visit("threads", self.threads);
    visit("max_seconds", self.max_seconds);
  }
};

enum class ImportOutcome {
  kImported,
  kIncomplete,  ///< A file that the object names is not there.
  kInvalid,     ///< A file does not follow its format, takes too much time or memory, or the user
                ///< has to say more.
  kRefused,     ///< It is in order, but cannot be a door.
  kNotClosed,   ///< A mesh could not be closed.
  kExists,      ///< A part of that id was made with other settings; --overwrite replaces it.
  kStopped,     ///< A signal ended the run before its turn; parts made so far are kept.
};

/// "imported", "incomplete", "invalid", "refused", "not_closed", "exists", "stopped".
std::string_view NameOf(ImportOutcome outcome);

struct ImportedObject {
  ForeignSource source;
  std::string name;  ///< It names format and object, or the folder where it cannot be read.
  ImportOutcome outcome = ImportOutcome::kInvalid;
  std::string message;   ///< What, where and what to do; empty if imported.
  std::string category;  ///< Empty where it is not known.
  std::string mechanism;
  std::string body_id;  ///< Folder of the part below the output; empty if it has none.
  std::string handle_id;
  std::vector<std::string> notes;   ///< What was left out or assumed, of materials, too.
  double scale = 1;                 ///< Metres a unit of the source.
  bool mirrored = false;            ///< See ForeignObject::mirrored.
  double body_box_deviation_m = 0;  ///< See LoadedPart.
  double handle_box_deviation_m = 0;
  bool grasp_holds = false;  ///< See RefineGrasp(); false without a handle.
};

/// One entry for each object, in the order of the input; a source can hold several.
struct ImportReport {
  std::vector<ImportedObject> objects;
  int left_out = 0;  ///< Objects of other categories than ImportConfig::only.
};

/// Imports what FindObjects() found into `out`/<part id>/ and writes `out`/import.json.
///
/// Parts that several objects share are made once; another part that wants the same id gets "-2",
/// "-3", ... in the order of `sources`. A part that is there already, from the same source and
/// settings, is kept. Each part's folder appears complete or not at all, and only if all parts of
/// its object could be made. An object's failure is an outcome, never an Error, whatever the
/// reason, time and memory among them; the rest goes on. A body remembers where its object's handle
/// was, see author_place.h. Grasps are refined, see RefineGrasp(). Progress goes to standard error.
/// The parts do not depend on the number of threads.
ImportReport ImportObjects(const std::vector<ForeignSource>& sources,
                           const std::filesystem::path& out, const ImportConfig& config,
                           Existing existing);

/// A record of schema "doorforge.import", version 1.
nlohmann::ordered_json ToJson(const ImportReport& report);
/// Says for people what was imported, an object a line, and how many came to what.
std::string ImportText(const ImportReport& report);
/// "NAME: OUTCOME: why" of each object that was not imported.
std::vector<std::string> FaultsOf(const ImportReport& report);

}  // namespace doorforge

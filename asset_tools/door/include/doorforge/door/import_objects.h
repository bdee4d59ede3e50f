// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/door/grasp.h"
#include "doorforge/door/make_part.h"

namespace doorforge {

struct ImportConfig {
  std::string category = {};  ///< Empty: told by each object's folder, else its content.
  MakePartConfig make = {};
  int threads = 0;  ///< 0: all processors. Does not change the result.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("category", self.category);
    visit("make", self.make);
    visit("threads", self.threads);
  }
};

enum class ImportOutcome {
  kImported,
  kIncomplete,  ///< A file that the object names is not there.
  kInvalid,     ///< A file does not follow its format, or the object is no door.
  kNotClosed,   ///< A mesh could not be closed.
  kExists,      ///< A part of that id was made with other settings; --overwrite replaces it.
  kStopped,     ///< A signal ended the run before its turn; parts made so far are kept.
};

/// "imported", "incomplete", "invalid", "not_closed", "exists", "stopped".
std::string_view NameOf(ImportOutcome outcome);

struct ImportedObject {
  std::filesystem::path folder;
  std::string name;  ///< Sub-task and object, or the folder's name where it cannot be read.
  ImportOutcome outcome = ImportOutcome::kInvalid;
  std::string message;   ///< What, where and what to do; empty if imported.
  std::string category;  ///< Empty where it is not known.
  std::string mechanism;
  std::string body_id;  ///< Folder of the part below the output.
  std::string handle_id;
  double body_box_deviation_m = 0;  ///< See BoxDeviation().
  double handle_box_deviation_m = 0;
  bool grasp_holds = false;  ///< See RefineGrasp().
};

/// One entry for each object, in the order of the input.
struct ImportReport {
  std::vector<ImportedObject> objects;
};

/// The objects below `source`: itself if it is one, else all folders up to three levels down that
/// are, by path. Throws Error(kMissing) if there is none.
std::vector<std::filesystem::path> FindObjects(const std::filesystem::path& source);

/// Imports composed objects of UniDoorManip into `out`/<part id>/ and writes `out`/import.json.
///
/// Parts are named "udm-<7 digits>". A part that several objects share is made once; another part
/// of the same digits (the release draws a scale per object) gets "-2", "-3", ... in the order of
/// `folders`. A part that is there already, from the same source and settings, is kept. Each part's
/// folder appears complete or not at all, and only if its object's other half could be made too.
/// An object's failure is an outcome, never an Error; the rest goes on. Grasps are refined, see
/// RefineGrasp(). Progress goes to standard error. The parts do not depend on the number of
/// threads.
ImportReport ImportObjects(const std::vector<std::filesystem::path>& folders,
                           const std::filesystem::path& out, const ImportConfig& config,
                           Existing existing);

/// A record of schema "doorforge.import", version 1.
nlohmann::ordered_json ToJson(const ImportReport& report);

}  // namespace doorforge

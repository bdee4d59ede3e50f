// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/foreign/articulated_object.h"
#include "doorforge/validate/validate_door.h"

#include "check/mesh_measures.h"
#include "faults/fault_list.h"

namespace doorforge::foreign {

/// What can be done with a file after its text has been read.
enum class AfterText {
  kNothing,
  kAsk,    ///< Other programs may be asked; there is no object.
  kJudge,  ///< The object, or the mesh of a glTF, is there.
};

struct TextRead {
  ValidatedKind kind = ValidatedKind::kUnknown;
  AfterText after = AfterText::kNothing;
  std::vector<std::string> notes;
  ArticulatedObject object;
  TriangleMesh mesh;
};

/// Whether the text of files with this ending, in small letters, is read by ReadText().
bool IsText(const std::string& ending);
/// What files with the ending are where nothing more is known of them.
ValidatedKind KindByEnding(const std::string& ending);

/// Reads the text of a URDF, MJCF, SDF, USDA or glTF: its words and numbers, no rule on what they
/// mean. It opens the file, buffers of a glTF and includes of an MJCF below the root.
TextRead ReadText(const std::filesystem::path& file, const MeshFiles::Places& places,
                  FaultList& faults);

}  // namespace doorforge::foreign

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/foreign/articulated_object.h"
#include "doorforge/foreign/validate_foreign.h"

#include "check/mesh_measures.h"

namespace doorforge::foreign {

/// What a file was read into, and where the files that it names are looked for. A file of triangles
/// alone is an object of one link with one shape.
struct ReadObject {
  ArticulatedObject object;
  MeshFiles::Places places;
};

/// Reads as ForeignValidator::Validate() does, whose report has the faults. Throws as the readers
/// do where the file takes too much of anything.
ReadObject ReadObjectOf(const std::filesystem::path& file, const std::filesystem::path& searched,
                        const ForeignChecks& checks);

}  // namespace doorforge::foreign

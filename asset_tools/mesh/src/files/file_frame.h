// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/mesh/import_mesh.h"

// What formats say of axes and unit. Runs in the process doorforge-read-mesh only.

namespace doorforge {

/// glTF 2.0, section 3.4: y up, the front of a model faces z, metres.
FileFrame FrameOfGltf();

/// COLLADA's first <asset>: its <up_axis>, of which y is the default, and the metres of its <unit>,
/// of which one is. What points at the viewer follows from what points up by the table of the
/// specification. Throws Error(kFormat) on an axis that is none of the three and on a unit that is
/// no number above 0.
FileFrame FrameOfCollada(const std::string& text);

/// Throws Error(kFormat), naming the node, where a rotation in a glTF or GLB is not of length 1,
/// which would shear what it carries. Leaves everything else that is wrong with the file to its
/// reader.
void RefuseGltfRotations(const std::filesystem::path& path, const MeshImportLimits& limits);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/triangle_mesh.h"

#include "faults/fault_list.h"

namespace doorforge::foreign {

/// The bytes of a buffer that lies in another file; nothing, and a finding, where there is none.
using BufferReader = std::function<std::optional<std::string>(const ForeignFileName&)>;

/// Checks the structure of glTF 2.0, binary or as JSON text, against its specification and gives
/// the triangles of its scene in its frame: those of primitives whose accessors hold. Compressed
/// meshes are left out.
TriangleMesh CheckGltf(std::string_view bytes, const std::string& file, const BufferReader& buffers,
                       FaultList& faults);

/// The triangles of a binary glTF. Throws RawMeshFault with the first fault of its structure.
TriangleMesh GlbTriangles(std::string_view bytes);

}  // namespace doorforge::foreign

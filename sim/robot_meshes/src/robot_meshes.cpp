// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/robot_meshes/robot_meshes.h"

#ifdef DOORFORGE_WITH_MESH_READING
#include "doorforge/mesh/import_mesh.h"
#endif

namespace doorforge {

RobotMeshReader RobotMeshes() {
#ifdef DOORFORGE_WITH_MESH_READING
  return [](const std::filesystem::path& path) { return MergedPieces(ImportMesh(path)); };
#else
  return {};
#endif
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// doorforge-read-mesh, which ImportMesh() starts; see read_mesh_process.h for its arguments.

#include "doorforge/mesh/read_mesh_process.h"

int main(int argc, char** argv) {
  return doorforge::ReadMeshForParent({argv, static_cast<std::size_t>(argc)});
}

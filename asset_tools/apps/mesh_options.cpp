// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_options.h"

namespace doorforge {

LooseMeshConfig UnsetMeshOptions() {
  return {.role = "", .mechanism = "", .unit = "", .hinge = "", .license = ""};
}

void AddMeshOptions(CLI::App& app, const std::string& prefix, LooseMeshConfig& mesh) {
  const std::string p = "--" + prefix;
  app.add_option(p + "unit", mesh.unit,
                 "of a mesh file: m, cm, mm, in or ft; told by its size if left out");
  app.add_option(p + "size", mesh.size_m,
                 "of a mesh file: length of its longest side in m, whatever its unit");
  app.add_option(p + "scale", mesh.scale,
                 "of a mesh file: one factor, or three along the file's axes")
      ->expected(1, 3);
  app.add_option(p + "front", mesh.front, "axis of a mesh file, or X,Y,Z, out of the door");
  app.add_option(p + "mount", mesh.mount,
                 "x y z in a mesh file: where the handle goes, or the point on its axis that lies "
                 "on the leaf")
      ->expected(3);
  app.add_option(p + "license", mesh.license, "SPDX expression, of mesh files and URDF");
  app.add_option(p + "up", mesh.up, "axis of the file that points up: x, y, z, -x ..., or X,Y,Z");
}

void AddHandleMeshOptions(CLI::App& app, const std::string& prefix, LooseMeshConfig& mesh) {
  const std::string p = "--" + prefix;
  app.add_option(p + "mechanism", mesh.mechanism,
                 "of a handle's mesh file: none, lever, round, key, valve or flap");
  app.add_option(p + "rose", mesh.rose, "mesh file of what stays fixed around a handle");
}

void AddBodyMeshOptions(CLI::App& app, const std::string& prefix, LooseMeshConfig& mesh) {
  const std::string p = "--" + prefix;
  app.add_option(p + "hinge", mesh.hinge,
                 "of a leaf's mesh file, as seen from the front: left or right");
  app.add_option(p + "frame", mesh.frame, "mesh file of a leaf's frame");
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "doorforge/foreign/articulated_object.h"

#include "check/mesh_measures.h"
#include "check/object_tree.h"
#include "faults/fault_list.h"

namespace doorforge::foreign {

/// TRE: names, ends and loops.
void CheckTree(const ArticulatedObject& object, FaultList& faults);

/// JNT: each joint by itself.
void CheckJoints(const ArticulatedObject& object, FaultList& faults);

/// The bounds of a link's shapes in its frame and, by shape, of each; empty where nothing is known.
struct LinkBounds {
  Eigen::AlignedBox3d all;
  std::vector<Eigen::AlignedBox3d> shapes;
};

/// GEO: files, meshes and sizes of all shapes. Returns what INR and MEC are measured with.
std::vector<LinkBounds> CheckShapes(const ArticulatedObject& object, const ObjectTree& tree,
                                    MeshFiles& files, FaultList& faults);

/// INR: masses and inertias.
void CheckInertials(const ArticulatedObject& object, const ObjectTree& tree,
                    const std::vector<LinkBounds>& bounds, FaultList& faults);

/// The faults of a mesh's triangles; `place` is where it is named, `name` goes before the measure.
void CheckTriangles(const MeshMeasure& mesh, const SourcePlace& place, const std::string& name,
                    FaultList& faults);

}  // namespace doorforge::foreign

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// Parses USD's text form into the value that a URDF gives, with the limits of ReadUrdf() and
/// faults as there.
///
/// Links are prims with PhysicsRigidBodyAPI, named by their last name, or by their path where two
/// have the same; their frames are those of the joints that move them. Joints are fixed, revolute
/// and prismatic ones of UsdPhysics; a joint to the world is left out where its child is the root.
/// Shapes are meshes, cubes (UrdfTriangles), spheres and cylinders; what has PhysicsCollisionAPI
/// collides, all else is drawn. What lies on no body belongs to a link "world" if there is one
/// shape of it, fixed to the root. Lengths become metres, and a stage whose y is up is turned z up.
/// Colours are displayColor's. `model.words` has what an export of this project says.
///
/// Time, composition (references, payloads, variants), instances and points of other types are not
/// read: a prim with a reference or payload is kUnusable, since what it holds is elsewhere. A prim
/// whose transform a rigid motion and a scale of its own shape do not make is kUnusable, too.
UrdfModel ParseUsdaModel(const std::string& text, const std::string& name,
                         std::vector<UrdfFault>& faults);
UrdfModel ReadUsda(const std::filesystem::path& path, std::vector<UrdfFault>& faults);

}  // namespace doorforge

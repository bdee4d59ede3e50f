// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/rigid_transform.h"

namespace doorforge {

/// Mass, centre and inertia of a rigid body, all in one stated frame.
struct MassProperties {
  double mass_kg = 0;
  Eigen::Vector3d center_of_mass_m = Eigen::Vector3d::Zero();
  /// Inertia about the centre of mass, along the frame's axes [kg m^2]; symmetric.
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();
};

/// Measures a body of uniform density that fills the mesh, in the mesh's frame. Exact up to
/// rounding: the integrals over the polyhedron of Mirtich (1996), in the form of Eberly,
/// "Polyhedral Mass Properties" (2002). Where pieces of the mesh overlap, the overlap counts once
/// for each piece. Throws Error(kInvalidArgument) unless the density is positive and finite.
MassProperties MassPropertiesOf(const ClosedMesh& mesh, double density_kg_m3);

/// The bodies as one, rigidly joined; all in one frame. Of no bodies, or of bodies without mass:
/// zeros.
MassProperties Combined(std::span<const MassProperties> bodies);

/// Returns what the same body has when it is seen from frame a.
MassProperties Transformed(const MassProperties& in_b, const RigidTransform& a_from_b);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/mass_properties.h"

#include <cmath>

#include "doorforge/core/error.h"

#include "volume_moments.h"

namespace doorforge {
namespace {

// Inertia of the point mass distribution whose second moment is `covariance`.
Eigen::Matrix3d InertiaOf(const Eigen::Matrix3d& covariance) {
  return covariance.trace() * Eigen::Matrix3d::Identity() - covariance;
}

}  // namespace

MassProperties MassPropertiesOf(const ClosedMesh& mesh, double density_kg_m3) {
  Require(std::isfinite(density_kg_m3) && density_kg_m3 > 0, ErrorCode::kInvalidArgument,
          "the density must be positive and finite");
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.mesh().vertices) bounds.extend(vertex);
  // about the bounds' centre, which keeps the digits of a mesh far from the origin
  internal::VolumeMoments moments;
  internal::AddMoments(mesh.mesh(), bounds.center(), Eigen::Vector3d::Ones(), moments);
  const Eigen::Vector3d offset = moments.first / moments.volume;
  MassProperties body;
  body.mass_kg = density_kg_m3 * moments.volume;
  body.center_of_mass_m = bounds.center() + offset;
  body.inertia_kg_m2 =
      density_kg_m3 * InertiaOf(moments.second - moments.volume * offset * offset.transpose());
  return body;
}

MassProperties Combined(std::span<const MassProperties> bodies) {
  MassProperties whole;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (const MassProperties& body : bodies) {
    whole.mass_kg += body.mass_kg;
    first += body.mass_kg * body.center_of_mass_m;
  }
  if (whole.mass_kg == 0) return {};
  whole.center_of_mass_m = first / whole.mass_kg;
  for (const MassProperties& body : bodies) {
    const Eigen::Vector3d arm = body.center_of_mass_m - whole.center_of_mass_m;
    whole.inertia_kg_m2 += body.inertia_kg_m2 + body.mass_kg * InertiaOf(arm * arm.transpose());
  }
  return whole;
}

MassProperties Transformed(const MassProperties& in_b, const RigidTransform& a_from_b) {
  const Eigen::Matrix3d rotation = a_from_b.linear();
  MassProperties in_a;
  in_a.mass_kg = in_b.mass_kg;
  in_a.center_of_mass_m = a_from_b * in_b.center_of_mass_m;
  in_a.inertia_kg_m2 = rotation * in_b.inertia_kg_m2 * rotation.transpose();
  return in_a;
}

}  // namespace doorforge

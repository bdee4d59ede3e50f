// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/schemas/part.h"

namespace doorforge::internal {

/// How a part is changed about its own origin before it is used: x -> turn * (scale .* x).
struct PartMap {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();     ///< Positive; along the part's axes.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< Orthogonal; determinant -1 mirrors.

  bool IsIdentity() const;
};

/// The part with everything that has a place or a direction changed alike: meshes (mirrored ones
/// turned inside out again, so that they stay closed with positive volume), what authors drew (the
/// same, pictures as they are), convex pieces, masses
/// (of bodies of uniform density, so exact), the joint's line and its sense, mount and grasp. The
/// gripper is its own mirror image across the plane of its fingers, so a mirrored grasp is a
/// grasp. Handles are scaled alike in all directions.
Part MappedPart(Part part, const PartMap& map);

/// The mirror image across x = 0 or y = 0, or a turn about x by a multiple of 90 degrees; entries
/// are 0 and +-1, so coordinates stay exact.
Eigen::Matrix3d MirrorX();
Eigen::Matrix3d MirrorY();
Eigen::Matrix3d QuarterTurnsAboutX(int quarters);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/part.h"

namespace doorforge::internal {

/// A leaf and its hinge in some frame with z up, as authored.
struct AuthoredLeaf {
  PartJoint hinge;  ///< Axis of unit length; limits as authored.
  bool limited = true;
  TriangleMesh mesh;           ///< At zero angle.
  Eigen::AlignedBox3d around;  ///< It holds what does not move; it may be empty.
};

/// How a leaf opens, told in the frame of a part.
struct LeafMotion {
  std::string refusal;  ///< Why it is no door; the rest then means nothing.
  /// Turns the leaf, and what it carries, shut; in the authored frame.
  RigidTransform closing = RigidTransform::Identity();
  double ajar_rad = 0;  ///< The leaf was authored open by so much.
  /// A turn about z, and the mirror at y = 0 if `mirrored`.
  Eigen::Affine3d part_from_authored = Eigen::Affine3d::Identity();
  bool mirrored = false;
  bool level = false;  ///< The hinge is level: the leaf tilts.
  PartJoint hinge;     ///< In the part's frame; closed at 0, opens up to `upper_rad`.
};

/// See ReadHingedObject(). Deterministic.
LeafMotion FindLeafMotion(const AuthoredLeaf& leaf);

/// Maps a joint by a turn that may include a reflection, which reverses what is positive.
PartJoint MovedJoint(const PartJoint& joint, const Eigen::Affine3d& to_from_joint);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/part.h"

namespace doorforge::internal {

/// What is known of a handle besides its shape. Axes as those of a part.
struct HandleKnowledge {
  Category category = Category::kInterior;
  std::optional<Mechanism> mechanism;           ///< Nothing: told by joint and shape.
  std::optional<PartJoint> joint;               ///< Nothing: it does not turn. Limits are not read.
  std::optional<double> leaf_plane_m = {};      ///< x of the leaf's surface; else the rearmost.
  std::optional<Eigen::Vector3d> grasp_m = {};  ///< Where to grasp; else told by the shape.
};

/// The facts of a handle, and where its frame lies in the frame that its mesh was given in.
struct HandlePlace {
  Eigen::Vector3d mount_m = Eigen::Vector3d::Zero();
  Mechanism mechanism = Mechanism::kNone;
  PartJoint joint;  ///< In the handle's frame, from 0 to HandleRange().
  RigidTransform part_from_grasp = RigidTransform::Identity();
};

/// Finds the mount and a grasp to begin with.
///
/// The mount lies where the leaf's plane meets the handle's axis; of a handle that does not turn,
/// or whose axis runs along the leaf, in the middle of its bounds. A handle that turns is a lever
/// if it reaches to one side of its axis, a flap if its axis runs along the leaf, else round, and a
/// valve on a safe. A lever turns down, a flap out. `handle` must not be empty. Deterministic.
HandlePlace PlaceHandle(const TriangleMesh& handle, const HandleKnowledge& known);

/// Where a handle goes on a leaf that comes without: near the free edge, at half height, on tall
/// interior doors 0.8 m above the leaf's bottom, as in UniDoorManip.
Eigen::Vector3d DefaultMount(const TriangleMesh& leaf, Category category);

}  // namespace doorforge::internal

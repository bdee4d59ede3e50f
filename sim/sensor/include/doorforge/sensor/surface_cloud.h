// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {

/// Points drawn once on all surfaces of a scene, hidden ones too, which then move with their links:
/// the whole cloud that environments without a camera give.
class SurfaceCloud {
 public:
  /// Each point lies on a triangle drawn by its area, evenly within it.
  ///
  /// @param count Points, at least 0; none are drawn where no mesh has an area.
  SurfaceCloud(std::span<const VisibleMesh> meshes, int count, Rng rng);

  /// The points in the world [m], in the order in which they were drawn, but for those whose z is
  /// `min_height_m` or lower.
  ///
  /// @param world_from_link Poses by VisibleMesh::link; there must be one for each.
  LabelledCloud At(std::span<const RigidTransform> world_from_link, double min_height_m) const;

 private:
  struct Point {
    Eigen::Vector3d in_link_m;
    int link;
    PointLabel label;
  };
  std::vector<Point> points_;
};

}  // namespace doorforge

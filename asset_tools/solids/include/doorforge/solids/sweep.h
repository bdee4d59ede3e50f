// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "doorforge/solids/solid.h"

namespace doorforge::internal {

/// A point of a path with the direction of travel there.
struct PathPoint {
  Eigen::Vector3d position_m;
  Eigen::Vector3d tangent;  ///< Unit length.
  double length_m = 0;      ///< Along the path from its start.
};

/// Straight lines through `corners`, each inner corner rounded by an arc of `radius_m` (less where
/// the neighbouring lines are too short for it). Arcs have a point every 15 degrees or closer; a
/// corner without a turn stays a point of the path.
std::vector<PathPoint> FilletedPath(const std::vector<Eigen::Vector3d>& corners, double radius_m);

/// The path through these points as they are; tangents by central differences, `first` and `last`
/// at the ends.
std::vector<PathPoint> SmoothPath(const std::vector<Eigen::Vector3d>& points,
                                  const Eigen::Vector3d& first, const Eigen::Vector3d& last);

/// Cross-section of a sweep: |u / half_width|^exponent + |v / half_height|^exponent <= 1, with v
/// along the sweep's up direction and u across it and the path.
struct Section {
  double half_width_m = 0.008;
  double half_height_m = 0.008;
  double exponent = 2;  ///< 2: ellipse; 4 to 8: a rectangle with rounded corners.
};

/// Rings of a section moved along a path.
///
/// @param up Unit vector that no tangent is parallel to; v is its part normal to the tangent.
/// @param section Called with the fraction of the path's length in [0, 1].
/// @param dome_m Length of a rounded end beyond the last path point; 0 ends flat.
std::vector<Ring> SweepRings(const std::vector<PathPoint>& path, const Eigen::Vector3d& up,
                             const std::function<Section(double)>& section, double dome_m);

/// SweepRings() with `up` carried along the path, so that a tangent may turn into it: for paths
/// that leave a plane.
std::vector<Ring> TransportedSweepRings(const std::vector<PathPoint>& path,
                                        const Eigen::Vector3d& up,
                                        const std::function<Section(double)>& section,
                                        double dome_m);

/// A solid of revolution about the x axis.
struct LathePoint {
  double x_m;
  double radius_m;
};

/// Settings of a lathe beside its profile.
struct LatheShape {
  int sides = 32;            ///< 6 to 12 gives a faceted body.
  double flute_depth_m = 0;  ///< Depth of flutes along the axis, where the radius is largest.
  int flutes = 0;            ///< Around the circumference.
  double squareness = 2;     ///< Exponent of the cross-section: 2 round, 4 a rounded square.
  double aspect = 1;         ///< Extent along z relative to that along y.
};

/// Profile points in order of the sweep from the leaf outwards (x mostly rising), radii > 0. Hulls
/// are prisms around the profile: at most 4 % of the radius outside it.
Solid LatheSolid(const std::vector<LathePoint>& profile, const LatheShape& shape);

}  // namespace doorforge::internal

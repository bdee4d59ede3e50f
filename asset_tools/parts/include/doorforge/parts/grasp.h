// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// The parallel gripper that must fit: Franka Hand with its standard fingers.
struct GripperShape {
  double opening_m = 0.08;          ///< Between the pads when open.
  double pad_half_width_m = 0.008;  ///< Along the grasp frame's x.
  double pad_half_depth_m = 0.008;  ///< Along its z.
  double finger_half_width_m = 0.0105;
  double finger_thickness_m = 0.015;
  double finger_reach_m = 0.042;  ///< Grasp centre back to the palm.
  double tip_m = 0.009;           ///< Grasp centre forward to the finger tips.
};

/// What lies between and around the fingers at one grasp.
struct GraspFit {
  double width_m = 0;       ///< The grip's material between the pads is so wide; 0: there is none.
  double off_center_m = 0;  ///< Its middle is so far from the grasp frame, along that frame's y.
  /// Share of the pad's area, the smaller of both pads, that lies within 2.5 mm of where it
  /// touches.
  double contact = 0;
  double tip_clearance_m = 0;  ///< Finger tips to the mount plane x = 0.
  bool fingers_free = false;   ///< Open fingers and palm meet no material on the straight approach.
  bool holds = false;          ///< Free, something between the pads, and enough of it in contact.
};

/// `grip` turns, `handle` is everything of the handle, both in the part's frame. Sampled at 2 mm.
/// Deterministic.
GraspFit MeasureGrasp(const TriangleMesh& grip, const TriangleMesh& handle,
                      const RigidTransform& part_from_grasp, const GripperShape& gripper = {});

/// Returns the same grasp where the mount plane lies elsewhere: `holds` follows.
GraspFit WithTipClearance(GraspFit fit, double tip_clearance_m);

struct RefinedGrasp {
  RigidTransform part_from_grasp;
  /// How far the grasp frame may be off, along each of its axes, and still hold [m].
  Eigen::Vector3d half_extent_m;
  GraspFit fit;
  double moved_m = 0;     ///< From the proposal.
  double turned_rad = 0;  ///< About the approach.
};

/// The holding grasp nearest to a proposed one, in general terms: the proposal centred between the
/// fingers, else shifted along the handle and in depth, else also turned about the approach in
/// steps of 15 degrees. Where none holds, the proposal comes back with `fit.holds` false.
/// Deterministic.
RefinedGrasp RefineGrasp(const TriangleMesh& grip, const TriangleMesh& handle,
                         const RigidTransform& proposal, const GripperShape& gripper = {});

}  // namespace doorforge

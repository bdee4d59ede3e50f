// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// A door's spring bolt and its strike: what the simulated world and the exports build. The one
/// place for their numbers; docs/environment.md has the geometry and where the numbers come from.
///
/// The bolt slides along y of its frame, out of the leaf's free edge at the handle's height; x is
/// the way in which the edge goes as the door opens. Its position is 0 thrown and -throw_m drawn
/// back. The strike is fixed to the frame: from its corner along x it is `lip` towards the leaf,
/// along y the face that holds the bolt. At zero, play_m lie between bolt and face, and the bolt
/// reaches throw_m - clearance_m behind it; drawn back by throw_m, it passes the corner
/// at clearance_m.
struct Bolt {
  double throw_m = 0;
  double travel_m = 0;  ///< At least throw_m: from 0 down to -travel_m nothing stops it.
  double play_m = 0;
  double clearance_m = 0;
  /// Bolt is drawn back this far per angle of the handle, up to throw_m at the unlock angle.
  double travel_m_per_rad = 0;
  RigidTransform leaf_from_bolt = RigidTransform::Identity();  ///< At position 0.
  TriangleMesh bolt_hull;                                      ///< Convex, in its frame.
  Eigen::Vector3d tip_m =
      Eigen::Vector3d::Zero();  ///< The tip of the bolt is there, where the strike holds it.
  RigidTransform base_from_strike = RigidTransform::Identity();  ///< Origin at the corner.
  TriangleMesh strike_hull;                                      ///< Convex, in its frame.
  double strike_thickness_m = 0;                                 ///< Along x.

  double mass_kg = 0.05;
  double preload_n = 5;            ///< The spring pushes the bolt out with it at position 0.
  double stiffness_n_per_m = 300;  ///< The spring grows by it on the way in.
  double damping_n_s_m = 5;
  double friction = 0.15;  ///< Bolt and strike rub with it.
};

/// The bolt of a door whose handle turns; where its latch is not a bolt, that of an ordinary
/// mortise latch of 12 mm. Any side and opening. Pure.
///
/// Throws Error(kInvalidArgument) if the handle does not turn, the leaf is without a mesh, or throw
/// or unlock angle are not positive.
Bolt BoltOf(const DoorAsset& door);

/// Whether the bolt is behind the strike's face, so that the door cannot open: its tip reaches past
/// the corner on the closed door's side.
bool IsCaught(const Bolt& bolt, const DoorAsset& door, double hinge_rad, double position_m);

}  // namespace doorforge

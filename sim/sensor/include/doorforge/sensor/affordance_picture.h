// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

/// A heat map over a handle, and the grasp that was chosen from it; all in the world.
struct AffordanceMap {
  std::vector<float> point_xyz;       ///< [m], n x 3, n >= 1.
  std::vector<float> affordance_rad;  ///< n, finite: the door angle expected of a grasp there.
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();
  /// The middle between the pads; z is the way of approach, the fingers close along y.
  RigidTransform world_from_tcp = RigidTransform::Identity();
};

/// A view of the whole map and the hand before it, as far from it as the camera is and 26 degrees
/// to its right, because a hand that points away from who looks is hard to read.
/// Throws Error(kInvalidArgument) as AffordancePicture().
CameraModel CameraOn(const AffordanceMap& map, const CameraModel& camera);

/// The scene in shades of grey, what is labelled kHandle coloured by the map (viridis from the
/// least to the greatest of its values, each pixel by its three nearest points), over it the
/// contact as a white ring and the hand as red lines, whose arrows say how the fingers close;
/// below a colour scale in degrees. Lines are drawn over whatever is before them.
///
/// @throws Error(kInvalidArgument) if the map is empty, its sizes disagree or a number is not
///     finite; as DepthCamera::Render() and RenderPicture().
Picture AffordancePicture(DepthCamera& camera, std::span<const RigidTransform> world_from_link,
                          const CameraModel& view, const AffordanceMap& map);

}  // namespace doorforge

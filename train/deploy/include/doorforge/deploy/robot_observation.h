// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/deploy/calibrated_camera.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// A robot at the moment of a picture.
struct RobotState {
  Proprioception proprioception{};
  RigidTransform world_from_hand = RigidTransform::Identity();
  Eigen::Vector3d tcp_in_world_m = Eigen::Vector3d::Zero();
  std::optional<bool> unlocked;  ///< Whether the handle has been turned, where the file says.
};

/// Reads a state file, docs/act.md. The hand's pose follows from the joints; one that the file
/// gives must agree with it within 2 cm and 5 degrees.
///
/// @param robot One that HasProprioception().
/// @throws Error(kInvalidConfig) as ReadCalibratedCamera(), and for joints beyond their limits by
///     more than 5 % of their range (degrees, or another order of joints); Error(kMissing).
RobotState ReadRobotState(const std::filesystem::path& path, const RobotModel& robot);

/// What a policy is given of a picture and a state, made as the recorder of data sets makes it:
/// cropped, point 0 the visible point nearest to the tool centre, sampled. `privileged` is left
/// empty; `visible_count` goes to the caller.
///
/// @throws Error(kInvalidArgument) as RequirePlausibleDepths(), if picture and camera differ in
///     size, or fewer points than
///     `config.point_count` are left after the crop (the recorder fills up with copies; in a real
///     picture so few points mean a fault), with the numbers that explain it.
struct RobotObservation {
  Observation observation;
  int visible_count = 0;
};
RobotObservation ObserveDepth(const DepthImage& depth, const CalibratedCamera& camera,
                              const RobotState& state, const CloudConfig& config = {});

/// What a policy remembers of the time before the robot came.
struct RememberedPoints {
  LabelledCloud visible;     ///< Every point that was visible then, in the world.
  double crop_radius_m = 0;  ///< CloudExtent::crop_radius_m of the joint cloud.
};

/// The points of a picture that was taken before the robot came.
///
/// @param depth By `camera`, or by the same camera with a whole number of times, at most 8, as many
///     pixels along each side.
/// @throws Error(kInvalidArgument) as ObserveDepth().
LabelledCloud ObserveBefore(const DepthImage& depth, const CalibratedCamera& camera,
                            const CloudConfig& config = {});

/// Does what ObserveDepth() does, and joins it with what is remembered, as JoinedCloud() does.
RobotObservation ObserveDepth(const DepthImage& depth, const CalibratedCamera& camera,
                              const RobotState& state, const RememberedPoints& before,
                              const CloudConfig& config = {});

/// What a grasper is given of a picture of the closed door, and how much of it there is.
struct HandleObservation {
  GraspObservation view;
  int visible_count = 0;  ///< Points inside the crop.
  int handle_count = 0;   ///< So many of these lie on the handle.
};

/// Does what ObserveDepth() does for the handle that the mask shows.
///
/// @param approach World: straight into the leaf.
/// @throws Error(kInvalidArgument) as ObserveDepth(), if picture and mask differ in size, or no
///     pixel of the mask is inside the crop.
HandleObservation ObserveHandle(DepthImage depth, const PixelMask& handle,
                                const CalibratedCamera& camera, const Eigen::Vector3d& approach,
                                const CloudConfig& config = {});

/// Does the same where nobody says which points are the handle: none is labelled as one, and the
/// approach is against the world's x.
///
/// @throws Error(kInvalidArgument) as ObserveDepth().
HandleObservation ObserveClosedDoor(const DepthImage& depth, const CalibratedCamera& camera,
                                    const CloudConfig& config = {});

}  // namespace doorforge

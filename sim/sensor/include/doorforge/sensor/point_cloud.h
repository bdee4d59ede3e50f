// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <type_traits>

#include <Eigen/Core>

#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/depth_noise.h"
#include "doorforge/sensor/lens.h"
#include "doorforge/sensor/pinhole_view.h"

namespace doorforge {

/// What of a depth image becomes the policy's cloud (UniDoorManip, reference code).
struct CloudConfig {
  double max_depth_m = 2.5;   ///< Points at this depth or farther are dropped.
  double min_height_m = 0.1;  ///< Points at this world z or lower are dropped.
  int point_count = 4096;     ///< In [1, 1000000].
  DepthNoiseConfig noise{};   ///< The depth image that the cloud is made of has it.
  /// The points lie on all surfaces, as evenly as their areas, and not on what a camera sees: no
  /// depth, no noise, nothing hidden. Only the height crops them.
  bool whole = false;
  bool robot = true;  ///< False: the robot is left out, so that it hides nothing.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("max_depth_m", self.max_depth_m);
    visit("min_height_m", self.min_height_m);
    visit("point_count", self.point_count);
    visit("noise", self.noise);
    // Configurations are recorded with the data: those from before there was a choice stay as they
    // are, byte by byte. A configuration that is read is not const.
    if (!std::is_const_v<Self> || self.whole) visit("whole", self.whole);
    if (!std::is_const_v<Self> || !self.robot) visit("robot", self.robot);
  }
};

/// Every pixel of `image` inside the crop as a point in the world, in pixel order.
///
/// The image is taken as it is: `config.noise` is for whoever makes the image.
///
/// A pixel whose depth is not above 0, such as one that a sensor left out, is no point. Where the
/// image has colours, the points have theirs.
///
/// @param image Rendered with this very `camera`, or with the one that it is believed to be.
/// @throws Error(kInvalidArgument) if the sizes of image and camera, or of depth and colours,
/// differ.
LabelledCloud CropCloud(const DepthImage& image, const CameraModel& camera,
                        const CloudConfig& config = {});
LabelledCloud CropCloud(const DepthImage& image, const PinholeView& view,
                        const CloudConfig& config = {});
/// Does the same for a camera with a lens, whose pixels look along `directions`.
LabelledCloud CropCloud(const DepthImage& image, const RigidTransform& world_from_camera,
                        const PixelDirections& directions, const CloudConfig& config = {});

/// The pixel that a point of a cloud was made of, as an index into `image`: the one whose point in
/// CropCloud(image, view) is the same, bit for bit. Nothing if no pixel's is.
///
/// @throws Error(kInvalidArgument) if the sizes of image and view differ.
std::optional<std::size_t> PixelOfPoint(const DepthImage& image, const PinholeView& view,
                                        const Eigen::Vector3f& point);

/// How many points a cloud has, and from how far around its first.
struct CloudExtent {
  int point_count = 4096;  ///< In [1, 1000000].
  /// Visible points farther than this from point 0 are left out [m], which spends all points on
  /// what is near; 0: none is.
  double crop_radius_m = 0;
};

struct SampledCloud {
  /// Exactly `point_count` points, or none at all if nothing is visible inside the crop.
  LabelledCloud cloud;
  int visible_count = 0;  ///< Points to sample from: in the crop and within the extent.
};

/// Farthest point sampling of a cropped cloud, whose points keep their labels and colours.
///
/// Point 0 is the visible point nearest to `start_m` (lowest index among equals). The reference
/// code starts with the first pixel instead; but its networks read the feature of point 0 to
/// decide about the grasp, so that point should be where the gripper is.
///
/// With fewer visible points than `point_count` all of them are taken, and the sequence is repeated
/// from its start until the cloud is full.
///
/// @param start_m World position, in general the gripper's.
/// @throws Error(kInvalidArgument) if point_count is out of range, start_m is not finite, or
///     crop_radius_m is negative or not finite.
SampledCloud SampleCloud(const LabelledCloud& visible, const Eigen::Vector3d& start_m,
                         const CloudExtent& extent);

/// CropCloud() and SampleCloud() in one.
SampledCloud ObserveCloud(const DepthImage& image, const CameraModel& camera,
                          const Eigen::Vector3d& start_m, const CloudConfig& config = {});

}  // namespace doorforge

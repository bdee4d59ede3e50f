// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/schemas/motion_way.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// One decision of a stage, as the networks see it (UniDoorManip, Section 4).
struct TrainingSample {
  /// 4096 x 3, world [m]; point 0 is the visible point nearest to the hand, at "grasp" to the
  /// contact. Not owned.
  std::span<const float> cloud;
  std::span<const std::uint8_t> rgb{};  ///< Of each point, sRGB. Not owned; empty: none are known.
  /// PointLabel of each point. Not owned; the stage "grasp" alone reads it.
  std::span<const std::uint8_t> label{};
  Proprioception proprioception{};
  /// What the expert did; at the stage "grasp" the contact point in the world and the rotation that
  /// were tried.
  ActionVector action{};
  /// What was executed: the expert's action with noise, or a learner's. The critic rates it.
  ActionVector executed{};
  float angle_gain_rad = 0;  ///< What was executed gained: the critic's target.
  /// Unit, world: straight into the closed leaf. Of the stage "grasp".
  std::array<float, 3> approach{};
  /// How far from point 0 the cloud's points were taken [m]; 0: wherever any was visible.
  float cloud_crop_radius_m = 0;
  /// How many times finer than the camera's picture that was from before the robot came, whose
  /// points the cloud holds as well; 0: the cloud is of what was visible at the decision.
  int remembered_finer = 0;
  /// Which way the stage's motion takes at this door; what is seen need not say it.
  MotionWay way = MotionWay::kUsual;
  /// The sample is of the mirror image of its scene (mirror.h): all of it says so but the cloud,
  /// which is not owned. ShownCloud() is the mirror image's.
  bool is_mirrored = false;
  bool is_upside_down = false;  ///< Likewise in a level mirror, see MirroredUpright().
};

/// The points that a network is shown: the sample's cloud, or its mirror image, kept in `storage`.
std::span<const float> ShownCloud(const TrainingSample& sample, std::vector<float>& storage);

}  // namespace doorforge

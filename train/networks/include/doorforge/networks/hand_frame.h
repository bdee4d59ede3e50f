// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/networks/training_sample.h"

namespace doorforge::internal {

/// The action with the turn from the present rotation of the hand instead of the absolute one: rows
/// of world_from_target * hand_from_world, near the identity. The position stays.
ActionVector TurnOf(const ActionVector& action, const Eigen::Matrix3d& world_from_hand);

/// Inverse of TurnOf().
ActionVector TargetOf(const ActionVector& turn, const Eigen::Matrix3d& world_from_hand);

/// The sample with turns for `action` and `executed`.
TrainingSample WithTurns(const TrainingSample& sample);

/// The sample in the mirror image of its scene, see MirroredSideways(), but for its cloud, which is
/// not the sample's own.
TrainingSample WithoutCloudMirrored(const TrainingSample& sample);

/// It does the same, and ShownCloud() gives the mirror image's points as well.
TrainingSample InMirror(const TrainingSample& sample);

/// It does the same in a level mirror, in which a handle unlocks the other way, see
/// MirroredUpright().
TrainingSample UpsideDown(const TrainingSample& sample);

/// The sample of a grasp with its contact told from point 0 of its cloud.
TrainingSample AboutContact(const TrainingSample& sample);

}  // namespace doorforge::internal

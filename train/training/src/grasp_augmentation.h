// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <Eigen/Core>

#include "doorforge/core/rng.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/training_sample.h"
#include "doorforge/training/train_stage.h"

namespace doorforge::internal {

/// How a tried grasp is shown otherwise than it was: door and hand turned together about the way
/// into the leaf, and mirrored at the upright plane along it. What comes of a grasp depends on how
/// the fingers lie around the handle, hardly on which way that is turned.
/// @param approach Unit, not upright.
/// @returns Orthogonal, determinant -1 where mirrored; identity where the config asks for nothing.
Eigen::Matrix3d DrawAugmentation(const TrainConfig& config, const Eigen::Vector3d& approach,
                                 Rng& rng);

/// The geometry of the cloud that `augmentation` makes, about the window's centre: distances stay,
/// and with them who is whose neighbour.
std::shared_ptr<const CloudGeometry> Augmented(const std::shared_ptr<const CloudGeometry>& geometry,
                                               const Eigen::Matrix3d& augmentation);

/// A grasp told from the contact. A mirrored hand is a hand: its fingers change places.
ActionVector Augmented(const ActionVector& grasp, const Eigen::Matrix3d& augmentation);

}  // namespace doorforge::internal

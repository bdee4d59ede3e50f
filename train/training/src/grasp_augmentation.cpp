// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "grasp_augmentation.h"

#include <utility>

#include <Eigen/Geometry>

#include "doorforge/core/rigid_transform.h"

namespace doorforge::internal {
namespace {

void Turn(std::vector<float>& xyz, const Eigen::Matrix3f& augmentation) {
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> point(&xyz[i]);
    point = (augmentation * point).eval();
  }
}

}  // namespace

Eigen::Matrix3d DrawAugmentation(const TrainConfig& config, const Eigen::Vector3d& approach,
                                 Rng& rng) {
  Eigen::Matrix3d augmentation = Eigen::Matrix3d::Identity();
  if (config.augment_roll_rad > 0) {
    const double roll = rng.Uniform(-config.augment_roll_rad, config.augment_roll_rad);
    augmentation = RotationAbout(approach, roll).linear();
  }
  if (config.augment_mirror && rng.Uniform() < 0.5) {
    const Eigen::Vector3d sideways = Eigen::Vector3d::UnitZ().cross(approach).normalized();
    augmentation *= Eigen::Matrix3d::Identity() - 2 * sideways * sideways.transpose();
  }
  return augmentation;
}

std::shared_ptr<const CloudGeometry> Augmented(const std::shared_ptr<const CloudGeometry>& geometry,
                                               const Eigen::Matrix3d& augmentation) {
  if (augmentation.isIdentity(0)) return geometry;
  const Eigen::Matrix3f turn = augmentation.cast<float>();
  CloudGeometry augmented = *geometry;
  Turn(augmented.xyz, turn);
  for (CloudGeometry::Level& level : augmented.levels) Turn(level.centre_xyz, turn);
  return std::make_shared<const CloudGeometry>(std::move(augmented));
}

ActionVector Augmented(const ActionVector& grasp, const Eigen::Matrix3d& augmentation) {
  if (augmentation.isIdentity(0)) return grasp;
  Action action = FromVector(grasp);
  action.position_delta_m = (augmentation * action.position_delta_m).eval();
  action.world_from_hand_rotation = (augmentation * action.world_from_hand_rotation).eval();
  if (augmentation.determinant() < 0) action.world_from_hand_rotation.col(1) *= -1;
  return ToVector(action);
}

}  // namespace doorforge::internal

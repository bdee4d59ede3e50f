// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/trained_grasp.h"

#include <utility>

namespace doorforge {

TrainedGrasp::TrainedGrasp(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                           const CloudConfig& config, std::shared_ptr<GraspPolicy> policy)
    : point_count_(config.point_count),
      camera_(scene, door, robot, config, /*sees_robot=*/false),
      clearance_(robot),
      policy_(std::move(policy)) {}

std::optional<ChosenGrasp> TrainedGrasp::Choose(const SceneSnapshot& snapshot) {
  std::optional<GraspChoice> choice = Consider(snapshot);
  if (!choice) return std::nullopt;
  return ChosenGrasp{std::move(choice->cloud), choice->contact_m, choice->world_from_hand_rotation};
}

std::optional<GraspChoice> TrainedGrasp::Consider(const SceneSnapshot& snapshot) {
  GraspView view;
  view.visible = camera_.Look(snapshot).visible;
  view.approach = -snapshot.door[kHandleLink].linear().col(0);
  view.sample = [&](const Eigen::Vector3d& start, double within_m) {
    return SampleCloud(view.visible, start, {point_count_, within_m}).cloud;
  };
  view.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
    return clearance_.Fits(view.visible, contact_m, rotation);
  };
  return policy_->Choose(view);
}

}  // namespace doorforge

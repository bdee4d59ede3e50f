// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/remembered_view.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/rollout/camera_observer.h"

namespace doorforge {
namespace {

template <class T>
void Append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

SceneSnapshot ClosedDoor(const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
  SceneSnapshot closed;
  closed.phase = EpisodePhase::kStart;
  // the camera leaves the robot out, but wants a pose for each of its bodies
  closed.robot = robot.PoseAt(JointVector::Zero(robot.joint_count()), scene.world_from_robot_base);
  closed.door = DoorFromLinks(door, 0, 0);
  for (RigidTransform& pose : closed.door) pose = scene.world_from_door * pose;
  return closed;
}

}  // namespace

void CheckRememberedView(const RememberedViewConfig& config) {
  Require(config.resolution_scale >= 0 && config.resolution_scale <= 8, ErrorCode::kInvalidConfig,
          "config.remembered.finer: out of 0..8");
  Require(config.crop_radius_m >= 0 && config.crop_radius_m < 100, ErrorCode::kInvalidConfig,
          "config.remembered.within_m: out of 0..100");
}

LabelledCloud JoinedCloud(LabelledCloud visible, const LabelledCloud& before,
                          const Eigen::Vector3d& start_m, const CloudExtent& extent) {
  Append(before.xyz, visible.xyz);
  Append(before.label, visible.label);
  return SampleCloud(visible, start_m, extent).cloud;
}

RememberedView::RememberedView(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                               const CloudConfig& cloud, const RememberedViewConfig& config)
    : scene_(scene), door_(&door), robot_(&robot), cloud_(cloud), config_(config) {
  CheckRememberedView(config);
  Require(config.IsOn(), ErrorCode::kInvalidConfig,
          "config.remembered.finer: 0, so nothing is remembered");
  scene_.camera.width *= config.resolution_scale;
  scene_.camera.height *= config.resolution_scale;
}

LabelledCloud RememberedView::With(LabelledCloud visible, const Eigen::Vector3d& start_m) {
  if (!before_) {
    CameraObserver camera(scene_, *door_, *robot_, cloud_, /*sees_robot=*/false);
    before_ = camera.Render(ClosedDoor(scene_, *door_, *robot_)).visible;
  }
  return JoinedCloud(std::move(visible), *before_, start_m,
                     {cloud_.point_count, config_.crop_radius_m});
}

}  // namespace doorforge

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

void RequireRemembered(const RememberedViewConfig& config) {
  CheckRememberedView(config);
  Require(config.IsOn(), ErrorCode::kInvalidConfig,
          "config.remembered.finer: 0, so nothing is remembered");
}

RememberedLook LookFrom(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                        const RememberedViewConfig& config) {
  RequireRemembered(config);
  RememberedLook look;
  look.scene = scene;
  look.scene.camera.width *= config.resolution_scale;
  look.scene.camera.height *= config.resolution_scale;
  look.snapshot = ClosedDoor(scene, door, robot);
  return look;
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
  Require(
      visible.label.empty() || before.label.empty() || visible.rgb.empty() == before.rgb.empty(),
      ErrorCode::kInvalidArgument, "a cloud with colours is joined with one without");
  Append(before.xyz, visible.xyz);
  Append(before.label, visible.label);
  Append(before.rgb, visible.rgb);
  return SampleCloud(visible, start_m, extent).cloud;
}

LabelledCloud ClosedDoorCloud(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                              const CloudConfig& cloud) {
  CameraObserver camera(scene, door, robot, cloud, /*sees_robot=*/false);
  const SceneSnapshot closed = ClosedDoor(scene, door, robot);
  return SampleCloud(camera.Render(closed).visible, closed.door[kHandleLink].translation(),
                     {.point_count = cloud.point_count})
      .cloud;
}

RememberedLook LookBefore(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                          const CloudConfig& cloud, const RememberedViewConfig& config) {
  RememberedLook look = LookFrom(scene, door, robot, config);
  CameraObserver camera(look.scene, door, robot, cloud, /*sees_robot=*/false);
  CameraFrame frame = camera.Render(look.snapshot);
  look.as_calibrated = camera.as_calibrated();
  look.depth = std::move(frame.depth);
  look.visible = std::move(frame.visible);
  return look;
}

RememberedView::RememberedView(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                               const CloudConfig& cloud, const RememberedViewConfig& config)
    : scene_(scene), door_(&door), robot_(&robot), cloud_(cloud), config_(config) {
  RequireRemembered(config);
}

LabelledCloud RememberedView::With(LabelledCloud visible, const Eigen::Vector3d& start_m) {
  if (!before_) {
    const RememberedLook look = LookFrom(scene_, *door_, *robot_, config_);
    CameraObserver camera(look.scene, *door_, *robot_, cloud_, /*sees_robot=*/false);
    if (colors_) camera.ColorWith(colors_(look.scene, /*sees_robot=*/false));
    before_ = camera.Render(look.snapshot).visible;
  }
  return JoinedCloud(std::move(visible), *before_, start_m,
                     {cloud_.point_count, config_.crop_radius_m});
}

}  // namespace doorforge

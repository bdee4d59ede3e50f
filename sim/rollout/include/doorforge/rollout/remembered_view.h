// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include <Eigen/Core>

#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/color_source.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// What the policy that turns the handle remembers. The hand hides what it holds: of a knob the
/// camera shows it a handful of points, often none. But the camera saw the whole handle before the
/// robot came, and a locked door has not moved since.
struct RememberedViewConfig {
  /// The picture from before has this many times as many pixels along each side as the scene's
  /// camera, 1 to 8; 0: nothing is remembered, and the cloud is of what is visible now.
  int resolution_scale = 2;
  double crop_radius_m = 0.25;  ///< CloudExtent::crop_radius_m of the joint cloud; 0: all of it.

  bool IsOn() const { return resolution_scale > 0; }

  friend bool operator==(const RememberedViewConfig&, const RememberedViewConfig&) = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("finer", self.resolution_scale);
    visit("within_m", self.crop_radius_m);
  }
};

/// Throws Error(kInvalidConfig) on a number out of range.
void CheckRememberedView(const RememberedViewConfig& config);

/// The cloud that is sampled from what is visible now and what was visible before.
///
/// @param visible Every point that is visible now, in the world.
/// @param before Every point that was visible before the robot came, in the world.
/// @param start_m Point 0 is the point of both nearest to it.
/// @throws Error(kInvalidArgument) as SampleCloud() does, or if one of them has colours and the
///     other has not.
LabelledCloud JoinedCloud(LabelledCloud visible, const LabelledCloud& before,
                          const Eigen::Vector3d& start_m, const CloudExtent& extent);

/// What the scene's camera sees of the closed door before the robot comes: as many points as a
/// policy's cloud has.
///
/// @throws as CameraObserver.
LabelledCloud ClosedDoorCloud(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                              const CloudConfig& cloud);

/// What the scene's camera saw of the closed door before the robot came.
struct RememberedLook {
  Scene scene;  ///< Its camera is the finer one that the look was taken with.
  SceneSnapshot snapshot;
  CameraModel as_calibrated;  ///< The points were made with it.
  DepthImage depth;
  LabelledCloud visible;  ///< Every point inside the crop.
};

/// Throws Error(kInvalidConfig) as CheckRememberedView(), also where nothing is remembered; as
/// CameraObserver.
RememberedLook LookBefore(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                          const CloudConfig& cloud, const RememberedViewConfig& config);

/// The scene's camera on the closed door alone, rendered when it is first asked for. `door` and
/// `robot` must outlive it. Serves one thread at a time.
class RememberedView {
 public:
  /// Throws Error(kInvalidConfig) as CheckRememberedView(), also where nothing is remembered.
  RememberedView(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                 const CloudConfig& cloud, const RememberedViewConfig& config);

  /// The points from before have the colours that these sources give. Those that are visible now
  /// must have some as well.
  void ColorWith(ColorSources colors) { colors_ = std::move(colors); }

  /// Joins the points that are visible now with those from before, as JoinedCloud() does.
  LabelledCloud With(LabelledCloud visible, const Eigen::Vector3d& start_m);

 private:
  Scene scene_;
  const DoorAsset* door_;
  const RobotModel* robot_;
  CloudConfig cloud_;
  RememberedViewConfig config_;
  ColorSources colors_;
  std::optional<LabelledCloud> before_;
};

}  // namespace doorforge

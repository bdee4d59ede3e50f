// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "doorforge/rollout/color_source.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/point_cloud.h"
#include "doorforge/sensor/surface_cloud.h"

namespace doorforge {

/// What the camera sees of a robot and a door. Links: the door's base, leaf and handle are 0 to 2,
/// the body of robot joint j is 3 + j, and after these comes what is fixed to the robot's base.
std::vector<VisibleMesh> VisibleMeshesOf(const DoorAsset& door, const RobotModel& robot);

/// The links' poses at an instant, in the order of VisibleMeshesOf().
std::vector<RigidTransform> LinkPosesOf(const SceneSnapshot& snapshot);

/// What the policy's camera makes of an instant.
struct CameraFrame {
  DepthImage ideal;       ///< Without noise.
  DepthImage depth;       ///< The sensor gives it; without noise it is `ideal`.
  LabelledCloud visible;  ///< Every point inside the crop.
  SampledCloud sampled;   ///< It is drawn from the visible points.
};

/// The scene's camera: depth of robot and door, with the noise that the config asks for, cropped
/// and sampled to the policy's cloud. Point 0 is the visible point nearest to the tool centre. The
/// error of the camera's calibration is drawn once, the other noise for each look, from streams
/// "sensor/<door id>/<episode>/..." of the scene's seed. Serves one thread at a time.
class CameraObserver : public Observer {
 public:
  /// @throws Error(kInvalidArgument) as DepthCamera does, or if the camera is inside the closed
  ///     door; Error(kInvalidConfig) as
  ///     CheckDepthNoise().
  /// @param sees_robot False: only the door is there, as with CloudConfig::robot. With
  ///     CloudConfig::whole every look gives points on all surfaces, drawn from the stream
  ///     "sensor/.../surface"; images are as ever.
  CameraObserver(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                 const CloudConfig& config = {}, bool sees_robot = true);

  /// From now on the clouds of the stage "unlock" are joined with what is remembered.
  void Remember(RememberedView before);

  /// From now on the points of clouds have the colours that this source gives, which belongs to the
  /// same scene, and sampled clouds the picture that they were made of.
  ///
  /// @throws Error(kInvalidArgument) where clouds are whole: a picture does not show all of them.
  void ColorWith(std::unique_ptr<ColorSource> colors);

  /// From now on sampled clouds have this extent in the place of CloudConfig::point_count, and
  /// nothing before is remembered in them. Throws Error(kInvalidArgument) as SampleCloud().
  void SampleAs(const CloudExtent& extent);

  /// The camera where calibration believes it to be: what clouds are unprojected with.
  const CameraModel& as_calibrated() const { return camera_as_calibrated_; }

  CameraFrame Render(const SceneSnapshot& snapshot);
  LabelledCloud Observe(const SceneSnapshot& snapshot) override;
  std::any Save() const override { return looks_; }
  void Restore(const std::any& memory) override { looks_ = std::any_cast<int>(memory); }

 private:
  Rng Stream(const std::string& purpose) const;

  std::uint64_t seed_;
  std::string stream_;
  CameraModel model_;
  CameraModel camera_as_calibrated_;
  CloudConfig config_;
  CloudExtent extent_;
  DepthCamera camera_;
  std::optional<SurfaceCloud> whole_;
  std::optional<RememberedView> before_;
  std::unique_ptr<ColorSource> colors_;
  int looks_ = 0;
};

}  // namespace doorforge

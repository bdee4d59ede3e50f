// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {

/// How a picture of the scene is shaded. Lambert surfaces under a sun and an open sky; a pixel is
/// 2 x 2 samples.
struct ScenePictureConfig {
  int sky_rays = 4;       ///< Rays a sample that look for open sky (ambient occlusion), 1..64.
  bool floor = true;      ///< A matt floor at z = 0 that receives shadows.
  double exposure = 1.0;  ///< Factor on all light, > 0.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("sky_rays", self.sky_rays);
    visit("floor", self.floor);
    visit("exposure", self.exposure);
  }
};

/// Shaded picture of the scene, its links where MoveLinks() or Render() last put them. Normals are
/// smoothed across edges flatter than 40 degrees. For eyes only: contains no noise from a random
/// source, but its bytes may differ between instruction sets.
///
/// @throws Error(kInvalidArgument) if the camera's image is empty or larger than 8192 pixels a
/// side,
///     or the config is out of range.
Picture RenderPicture(SceneGeometry& scene, const CameraModel& camera,
                      const ScenePictureConfig& config = {});

/// Where to stand for a picture.
struct ViewConfig {
  int width = 960;
  int height = 720;
  double azimuth_rad = -0.6;    ///< From world x (towards who opens the door) towards y.
  double elevation_rad = 0.35;  ///< Above the horizon.
  double margin = 1.08;         ///< Distance over the smallest one that shows everything.
};

/// Three-quarter view that just shows all meshes at their present poses; 40 degrees wide. An empty
/// scene is seen from 3 m.
CameraModel FramingCamera(const SceneGeometry& scene, const ViewConfig& view = {});

/// The cloud's points as discs in the colours of their labels (body blue, handle orange, frame
/// grey, robot green, other violet), nearer ones over farther ones, on white, with a legend of the
/// labels that occur.
Picture CloudPicture(const LabelledCloud& cloud, const CameraModel& camera);

/// sRGB colour of a label in CloudPicture(), each in [0, 1].
Eigen::Vector3d ColorOf(PointLabel label);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/core/rng.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/depth_camera.h"

namespace doorforge {

/// What a real depth camera gets wrong. Off by default, as in the paper.
struct DepthNoiseConfig {
  /// "none"; "structured_light": the disparity noise, sub-pixel jitter and quantisation that Handa
  /// et al. (ICRA 2014) fitted to a Kinect; "time_of_flight": a spread that grows with the squared
  /// depth, flying pixels at edges, whole millimetres, of the size that Toelgyessy et al. (Sensors
  /// 2021) measured on an Azure Kinect: about 1 mm at 1.5 m.
  std::string sensor = "none";
  double scale = 1;           ///< Multiplies every spread; 0 leaves the quantisation alone.
  double edge_dropout = 0.3;  ///< Share of pixels without depth where the depth jumps.
  double edge_step_m = 0.03;  ///< A jump is a difference of this or more among 3 x 3 pixels.
  double grazing_rad = 1.4;   ///< No depth where the ray is this far from the surface's normal.
  double extrinsic_m = 0;     ///< Spread of the error of the camera's place along each axis.
  double extrinsic_rad = 0;   ///< Spread of the error of its pose about each axis.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("sensor", self.sensor);
    visit("scale", self.scale);
    visit("edge_dropout", self.edge_dropout);
    visit("edge_step_m", self.edge_step_m);
    visit("grazing_rad", self.grazing_rad);
    visit("extrinsic_m", self.extrinsic_m);
    visit("extrinsic_rad", self.extrinsic_rad);
  }
};

/// Throws Error(kInvalidConfig) on an unknown sensor or a number out of range: shares within 0..1,
/// grazing_rad within 0..pi/2, the others 0 or more and finite.
void CheckDepthNoise(const DepthNoiseConfig& config);

/// What the sensor makes of an ideal image. A pixel without depth has infinity, link -1 and label
/// kOther; a pixel that keeps a depth keeps its labels. One draw of `rng` gives one image.
///
/// @param ideal Rendered with this very `camera`.
/// @throws Error(kInvalidArgument) if the sizes of image and camera differ; CheckDepthNoise()'s.
DepthImage WithDepthNoise(const DepthImage& ideal, const CameraModel& camera,
                          const DepthNoiseConfig& config, Rng rng);

/// The camera where calibration believes it to be: what depth is unprojected with. The camera
/// itself if the config has no extrinsic error.
CameraModel BelievedCamera(const CameraModel& camera, const DepthNoiseConfig& config, Rng rng);

}  // namespace doorforge

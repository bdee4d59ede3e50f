// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/core/named_enum.h"
#include "doorforge/core/rng.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/depth_camera.h"

namespace doorforge {

/// The kinds of depth camera whose faults are known; docs/design/sensor.md says where each model is
/// from. A new one has its value here, its row below and its function in depth_noise.cpp.
enum class DepthSensor {
  kNone,  ///< The camera makes no mistakes.
  /// Disparities are noisy and quantised, and pixels jitter, as Handa et al. (ICRA 2014) fitted it
  /// to a Kinect.
  kStructuredLight,
  /// The spread grows with the squared depth, pixels fly at edges, and depth comes in whole
  /// millimetres; about 1 mm at 1.5 m, as Toelgyessy et al. (Sensors 2021) measured it on an Azure
  /// Kinect.
  kTimeOfFlight,
};
inline constexpr NamedValue<DepthSensor> kDepthSensors[] = {
    {DepthSensor::kNone, "none"},
    {DepthSensor::kStructuredLight, "structured_light"},
    {DepthSensor::kTimeOfFlight, "time_of_flight"}};
constexpr std::span<const NamedValue<DepthSensor>> ValuesOf(DepthSensor) { return kDepthSensors; }

/// What a real depth camera gets wrong. Off by default, as in the paper.
struct DepthNoiseConfig {
  DepthSensor sensor = DepthSensor::kNone;
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

/// Throws Error(kInvalidConfig) on a number out of range: shares are within 0..1, grazing_rad
/// within 0..pi/2, and the others 0 or more and finite.
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
CameraModel CameraWithCalibrationError(const CameraModel& camera, const DepthNoiseConfig& config,
                                       Rng rng);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/calibrated_camera.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "doorforge/core/error.h"

#include "camera_info.h"
#include "named_numbers.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::CameraInfo;
using internal::NamedNumbers;
using Json = nlohmann::ordered_json;

constexpr int kMostPixels = 8192;

// Ours beside a camera_info, which has neither pose nor unit.
const std::vector<std::string> kBesideInfo = {"camera_info", "rectified", "depth_unit_m",
                                              "world_from_camera"};

// Our own file's view and lens, without a camera_info.
void ReadIntrinsics(const NamedNumbers& file, CalibratedCamera& camera) {
  file.RequireKnown({"width", "height", "fx", "fy", "cx", "cy", "pixel_centre", "depth_unit_m",
                     "world_from_camera", "distortion_model", "distortion_coefficients",
                     "camera_info"});
  PinholeView& view = camera.view;
  view.width = file.WholeNumber("width", 1, kMostPixels);
  view.height = file.WholeNumber("height", 1, kMostPixels);
  view.fx = file.Number("fx", 1, 100.0 * kMostPixels);
  view.fy = file.Number("fy", 1, 100.0 * kMostPixels);
  // calibrations count from the centre of the first pixel, this library from its corner
  const double centre = file.Has("pixel_centre") ? file.Number("pixel_centre", 0, 0.5) : 0;
  if (centre != 0 && centre != 0.5)
    file.Fail("pixel_centre: expected 0 (OpenCV, ROS: the first pixel's centre is (0, 0)) or 0.5");
  view.cx = file.Number("cx", -kMostPixels, 2.0 * kMostPixels) + 0.5 - centre;
  view.cy = file.Number("cy", -kMostPixels, 2.0 * kMostPixels) + 0.5 - centre;
  if (file.Has("distortion_model") || file.Has("distortion_coefficients"))
    camera.lens = internal::LensNamed(file, file.Word("distortion_model"),
                                      file.Numbers("distortion_coefficients", 0, 14));
}

// Whether the picture is the rectified one: where that matters, the file has to say it.
bool IsRectified(const NamedNumbers& file, const CameraInfo& info) {
  if (file.Has("rectified")) return file.Flag("rectified");
  if (!info.alike)
    file.Fail(
        "the key \"rectified\" is missing: by its camera_info the camera distorts, so say which "
        "picture this is: false for that of the sensor (ROS: image_raw), true for the rectified "
        "one (image_rect)");
  return true;
}

void ReadPose(const NamedNumbers& file, CalibratedCamera& camera) {
  if (!file.Has("world_from_camera"))
    file.Fail(
        "the key \"world_from_camera\" is missing: where the camera is no camera_info says. Take "
        "it from the hand-eye calibration, such as `ros2 run tf2_ros tf2_echo world "
        "camera_depth_optical_frame` prints, the frame whose z looks forward");
  camera.view.world_from_camera = file.Pose("world_from_camera");
}

// `info`: the camera_info, maybe within the same file.
void ReadWithInfo(const NamedNumbers& own, const CameraInfo& info, CalibratedCamera& camera) {
  const bool is_rectified = IsRectified(own, info);
  camera.view = is_rectified ? info.rectified : info.raw;
  ReadPose(own, camera);
  if (is_rectified) return;
  camera.lens = info.lens;
  // a pose is of the frame that clouds are published in, which rectification turns to
  camera.view.world_from_camera.linear() =
      camera.view.world_from_camera.linear() * info.rectification;
}

NamedNumbers OwnKeysOf(const std::string& file, const Json& json) {
  Json own = Json::object();
  for (const std::string& key : kBesideInfo)
    if (json.contains(key)) own[key] = json[key];
  return {file, own};
}

void ReadUnit(const NamedNumbers& file, CalibratedCamera& camera) {
  if (!file.Has("depth_unit_m")) return;
  camera.metres_per_unit = file.Number("depth_unit_m", 1e-6, 1);
  camera.metres_per_float = camera.metres_per_unit;
}

CalibratedCamera ReadUndistorted(const fs::path& path) {
  const Json json = internal::ReadNamed(path);
  const NamedNumbers file(path.string(), json);
  CalibratedCamera camera;
  ReadUnit(file, camera);
  if (internal::IsCameraInfo(json)) {
    ReadWithInfo(OwnKeysOf(file.file(), json), internal::CameraInfoOf(file), camera);
  } else if (file.Has("camera_info")) {
    file.RequireKnown(kBesideInfo);
    const fs::path info = path.parent_path() / file.Word("camera_info");
    ReadWithInfo(file, internal::CameraInfoOf({info.string(), internal::ReadNamed(info)}), camera);
  } else {
    ReadIntrinsics(file, camera);
    camera.view.world_from_camera = file.Pose("world_from_camera");
  }
  return camera;
}

}  // namespace

CalibratedCamera WithLens(CalibratedCamera camera, const LensDistortion& lens) {
  camera.lens = lens;
  camera.directions.reset();
  if (lens.model == LensModel::kPinhole) return camera;
  auto directions = std::make_shared<PixelDirections>(DirectionsOf(camera.view, Lens(lens)));
  const auto seeing = std::ranges::count_if(
      directions->ideal, [](const Eigen::Vector2d& ideal) { return ideal.allFinite(); });
  const auto pixels = static_cast<std::ptrdiff_t>(directions->ideal.size());
  Require(2 * seeing >= pixels, ErrorCode::kInvalidArgument,
          "the distortion can be undone for " + std::to_string(seeing) + " of " +
              std::to_string(pixels) +
              " pixels only; look at distortion_model and at the coefficients' order (k1 k2 p1 p2 "
              "k3 ..)");
  camera.directions = std::move(directions);
  return camera;
}

CalibratedCamera WithFinerPixels(CalibratedCamera camera, int times) {
  PinholeView& view = camera.view;
  view.width *= times;
  view.height *= times;
  for (double* length : {&view.fx, &view.fy, &view.cx, &view.cy}) *length *= times;
  return WithLens(camera, camera.lens);
}

LabelledCloud CropCloud(const DepthImage& depth, const CalibratedCamera& camera,
                        const CloudConfig& config) {
  if (!camera.directions) return CropCloud(depth, camera.view, config);
  return CropCloud(depth, camera.view.world_from_camera, *camera.directions, config);
}

CalibratedCamera ReadCalibratedCamera(const fs::path& path) {
  const CalibratedCamera camera = ReadUndistorted(path);
  try {
    return WithLens(camera, camera.lens);
  } catch (const Error& error) {
    throw Error(ErrorCode::kInvalidConfig, path.string() + ": " + error.what());
  }
}

}  // namespace doorforge

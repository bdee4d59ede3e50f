// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/depth_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/npy.h"

#include "named_numbers.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Format;

constexpr std::uint64_t kMostPictureBytes = 512ULL << 20U;
constexpr double kNearest = 0.05;  // [m]
constexpr double kFarthest = 30;

// Metres, millimetres, and the finer units of RealSense.
constexpr std::array<double, 4> kUnits = {1, 0.001, 0.00025, 0.0001};
constexpr double kUsual = 1.5;      // [m] from a camera to a door
constexpr double kUsualFactor = 4;  // so much nearer or farther may a door well be

// The unit that makes a room of such numbers.
std::string WayOut(double median_units) {
  const auto distance = [&](double unit) {
    return std::fabs(std::log(unit * median_units / kUsual));
  };
  const double unit = *std::ranges::min_element(kUnits, {}, distance);
  if (distance(unit) > std::log(kUsualFactor)) return "";
  return Format("; with depth_unit_m: %g in the camera file it is %.3g m", unit,
                unit * median_units);
}

bool IsArray(std::string_view bytes) { return bytes.starts_with("\x93NUMPY"); }

bool IsFloat(std::string_view bytes, const std::string& name) {
  if (!IsArray(bytes)) return false;
  return ParseNpyHeader(std::as_bytes(std::span(bytes.data(), bytes.size())), name).type != "<u2";
}

// What OpenCV's imwrite() makes of floats.
void RequireKnownKind(std::string_view bytes, const std::string& name) {
  using namespace std::string_view_literals;
  const bool is_tiff = bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv);
  const bool is_exr = bytes.starts_with("\x76\x2f\x31\x01"sv);
  if (!is_tiff && !is_exr) return;
  throw Error(ErrorCode::kFormat,
              name + ": is " + (is_tiff ? "a TIFF" : "an EXR") +
                  ", which is not read; make an array of it: python3 -c \"import cv2, numpy; "
                  "numpy.save('depth.npy', cv2.imread('" +
                  fs::path(name).filename().string() + "', cv2.IMREAD_UNCHANGED))\"");
}

}  // namespace

std::optional<double> MedianDepth(const DepthImage& depth) {
  constexpr std::size_t kEnough = 20000;
  const std::size_t step = depth.depth_m.size() / kEnough + 1;
  std::vector<float> measured;
  for (std::size_t i = 0; i < depth.depth_m.size(); i += step) {
    const float metres = depth.depth_m[i];
    if (metres > 0 && std::isfinite(metres)) measured.push_back(metres);
  }
  if (measured.empty()) return std::nullopt;
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::ranges::nth_element(measured, middle);
  return *middle;
}

void RequirePlausibleDepths(const DepthImage& depth, const std::string& read_as) {
  const std::optional<double> median = MedianDepth(depth);
  if (!median || (*median >= kNearest && *median <= kFarthest)) return;
  throw Error(
      ErrorCode::kInvalidArgument,
      "the depths cannot be right: their median, read " + read_as +
          Format(", is %.4g m, and cameras see from %g to %g m", *median, kNearest, kFarthest));
}

DepthImage ReadDepthPicture(const fs::path& path, const CalibratedCamera& camera) {
  const std::string name = path.string();
  const std::string bytes = ReadFile(path, kMostPictureBytes);
  RequireKnownKind(bytes, name);
  const DepthUnits units{camera.metres_per_float, camera.metres_per_unit};
  DepthImage depth = IsArray(bytes) ? DecodeDepthNpy(bytes, units, name)
                                    : DecodeDepthPng(bytes, units.of_integer, name);
  const double unit = IsFloat(bytes, name) ? units.of_float : units.of_integer;
  try {
    RequirePlausibleDepths(depth, Format("with depth_unit_m: %g", unit));
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what() + WayOut(*MedianDepth(depth) / unit));
  }
  return depth;
}

PixelMask ReadMaskPicture(const fs::path& path) {
  return DecodeMaskPng(ReadFile(path, kMostPictureBytes), path.string());
}

void AddColors(const fs::path& path, DepthImage& depth) {
  if (path.empty()) return;
  Picture picture = DecodePicture(ReadFile(path, kMostPictureBytes), path.string());
  if (picture.width != depth.width || picture.height != depth.height)
    throw Error(ErrorCode::kInvalidArgument,
                path.string() + ": the colours have " + std::to_string(picture.width) + " x " +
                    std::to_string(picture.height) + " pixels, the depth has " +
                    std::to_string(depth.width) + " x " + std::to_string(depth.height) +
                    "; register the depth to the colours (realsense2_camera: align_depth), and "
                    "give the colour camera's calibration and pose");
  depth.rgb = std::move(picture.rgb);
}

}  // namespace doorforge

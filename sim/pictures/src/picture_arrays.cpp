// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "picture_arrays.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/schemas/npy.h"

namespace doorforge {
namespace {

constexpr double kMillimetres = 1000;
constexpr double kFarthestMillimetre = 65535;
constexpr float kNormalScale = 127;

template <class T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void AppendDepth(const DepthImage& image, std::string& bytes) {
  for (const float depth : image.depth_m) {
    const double millimetres = std::round(kMillimetres * static_cast<double>(depth));
    Append(bytes, millimetres <= kFarthestMillimetre ? static_cast<std::uint16_t>(millimetres)
                                                     : std::uint16_t{0});
  }
}

void AppendDepth32(const DepthImage& image, std::string& bytes) {
  for (const float depth : image.depth_m) Append(bytes, std::isfinite(depth) ? depth : 0.0F);
}

void AppendLabels(const DepthImage& image, std::string& bytes) {
  for (std::size_t i = 0; i < image.label.size(); ++i)
    Append(bytes, image.link[i] < 0 ? kNothingSeen : image.label[i]);
}

void AppendLinks(const DepthImage& image, std::string& bytes) {
  for (const std::int16_t link : image.link)
    Append(bytes, link < 0 ? kNothingSeen : static_cast<std::uint8_t>(link));
}

void AppendNormals(const SurfaceImage& surfaces, std::string& bytes) {
  for (const Eigen::Vector3f& normal : surfaces.normal) {
    for (const float component : normal)
      Append(bytes, static_cast<std::int8_t>(std::lround(kNormalScale * component)));
  }
}

void AppendPicture(PictureStream stream, const CameraPixels& pixels, std::string& bytes) {
  switch (stream) {
    case PictureStream::kRgb:
      bytes.append(reinterpret_cast<const char*>(pixels.rgb.data()), pixels.rgb.size());
      return;
    case PictureStream::kDepth:
      return AppendDepth(pixels.depth, bytes);
    case PictureStream::kDepth32:
      return AppendDepth32(pixels.depth, bytes);
    case PictureStream::kLabel:
      return AppendLabels(pixels.surfaces.depth, bytes);
    case PictureStream::kLink:
      return AppendLinks(pixels.surfaces.depth, bytes);
    case PictureStream::kNormal:
      return AppendNormals(pixels.surfaces, bytes);
  }
}

// The type of the array comes from where readers find it.
MemberBytes MemberOf(const std::string& name, const std::vector<std::size_t>& shape,
                     std::size_t looks, const std::string& bytes) {
  const std::optional<EpisodeFeature> feature = PictureFeature(name, shape);
  Require(feature.has_value(), ErrorCode::kInvalidArgument, "pictures: no array " + name);
  std::vector<std::size_t> whole = {looks};
  whole.insert(whole.end(), shape.begin(), shape.end());
  return {name + ".npy", MakeNpyHeader(feature->type, whole) + bytes};
}

}  // namespace

PictureArrays::PictureArrays(std::string camera, const std::vector<PictureStream>& streams)
    : camera_(std::move(camera)) {
  for (const PictureStream stream : streams) arrays_.push_back({stream, {}});
}

void PictureArrays::Add(const CameraPixels& pixels) {
  width_ = static_cast<std::size_t>(pixels.depth.width);
  height_ = static_cast<std::size_t>(pixels.depth.height);
  for (Array& array : arrays_) AppendPicture(array.stream, pixels, array.bytes);
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column)
      Append(poses_, pixels.world_from_camera.matrix()(row, column));
  }
  ++looks_;
}

void PictureArrays::MoveTo(std::vector<MemberBytes>& members) {
  for (const Array& array : arrays_) {
    std::vector<std::size_t> shape = {height_, width_};
    if (array.stream == PictureStream::kNormal || array.stream == PictureStream::kRgb)
      shape.push_back(3);
    members.push_back(MemberOf(PictureName(array.stream, camera_), shape, looks_, array.bytes));
  }
  members.push_back(MemberOf(PicturePoseName(camera_), {3, 4}, looks_, poses_));
  *this = PictureArrays(camera_, {});
}

}  // namespace doorforge

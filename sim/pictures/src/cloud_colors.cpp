// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "cloud_colors.h"

#include <optional>

#include <Eigen/Core>

#include "doorforge/core/error.h"
#include "doorforge/schemas/npy.h"
#include "doorforge/schemas/picture_streams.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {
namespace {

constexpr std::size_t kChannels = 3;

const std::uint8_t* ColorOf(const Eigen::Vector3f& point, std::span<const ColoredLook> looks) {
  for (const ColoredLook& look : looks) {
    if (const std::optional<std::size_t> pixel = PixelOfPoint(*look.depth, look.view, point))
      return &look.rgb.at(kChannels * *pixel);
  }
  throw Error(ErrorCode::kInvalidArgument,
              "pictures: a point of the cloud was made of no pixel of what was seen, so it has no "
              "colour; leave pictures.cloud_rgb out");
}

}  // namespace

void CloudColors::Add(const LabelledCloud& cloud, std::span<const ColoredLook> looks) {
  const std::size_t points = cloud.label.size();
  if (clouds_ == 0) points_ = points;
  Require(points == points_, ErrorCode::kInvalidArgument, "pictures: clouds differ in size");
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3f point(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]);
    bytes_.append(reinterpret_cast<const char*>(ColorOf(point, looks)), kChannels);
  }
  ++clouds_;
}

MemberBytes CloudColors::Member() const {
  return {std::string(kCloudColors) + ".npy",
          MakeNpyHeader("|u1", {clouds_, points_, kChannels}) + bytes_};
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/episode_arrays.h"
#include "doorforge/schemas/shard.h"

namespace doorforge {

/// What is recorded of a camera at each decision; see docs/images.md. The arrays have the shape
/// decisions x height x width, with three channels behind it for kRgb and kNormal.
enum class PictureStream {
  kRgb,      ///< sRGB, uint8.
  kDepth,    ///< Along the optical axis [mm], uint16; 0: nothing, or farther than 65.535 m.
  kDepth32,  ///< Along the optical axis [m], float32; 0: nothing.
  kLabel,    ///< PointLabel values, uint8; kNothingSeen: nothing.
  kLink,     ///< Link as in VisibleMeshesOf(), uint8; kNothingSeen: nothing.
  kNormal,   ///< Unit normal in the world, towards the camera, times 127, int8; 0: nothing.
};
inline constexpr NamedValue<PictureStream> kPictureStreams[] = {
    {PictureStream::kRgb, "rgb"},         {PictureStream::kDepth, "depth"},
    {PictureStream::kDepth32, "depth32"}, {PictureStream::kLabel, "label"},
    {PictureStream::kLink, "link"},       {PictureStream::kNormal, "normal"}};
constexpr std::span<const NamedValue<PictureStream>> ValuesOf(PictureStream) {
  return kPictureStreams;
}

inline constexpr std::uint8_t kNothingSeen = 255;  ///< In labels and links.

/// Bytes that a pixel takes.
std::size_t BytesAPixel(PictureStream stream);

/// "depth_front", the array's name: its member is "depth_front.npy".
std::string PictureName(PictureStream stream, std::string_view camera);
/// "pose_front", the array world_from_camera of each decision, 3 x 4 float64.
std::string PicturePoseName(std::string_view camera);

/// The array of the colours of clouds' points, sRGB, points x 3 a decision.
inline constexpr std::string_view kCloudColors = "cloud_rgb";

/// The feature that the array of a picture, of its camera's poses or of clouds' colours is.
///
/// @param name Such as "depth_front", or kCloudColors.
/// @param shape One decision has it; 0 stands for the number of points.
/// @return Nothing if no picture is called so or has such a shape.
std::optional<EpisodeFeature> PictureFeature(const std::string& name,
                                             const std::vector<std::size_t>& shape);

/// The arrays of pictures and clouds' colours that an episode has, sorted by name.
///
/// @throws Error(kFormat), naming tar and member, if an array that is called as a picture's is
///     damaged, or has another type, shape or number of decisions than one, or if there are not as
///     many colours as points.
std::vector<EpisodeFeature> PictureFeaturesOf(const ShardReader& reader, std::size_t episode);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/sensor/depth_camera.h"

namespace doorforge {

/// An sRGB picture, 8 bits a channel.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< Height x width x 3, row by row from the top left.
};

/// PNG files as bytes. Nothing but pixels is written, so equal pictures give equal bytes.
/// Throws Error(kInvalidArgument) on an empty picture.
std::string EncodePng(const Picture& picture);

/// Bytes of a JPEG file, for eyes alone: a quarter of the PNG's. `quality` lies in 1..100. Throws
/// as EncodePng() does. The same build gives the same bytes.
std::string EncodeJpeg(const Picture& picture, int quality = 85);

/// 16-bit grey PNG of the depth in millimetres, rounded; 0 where nothing is seen or beyond 65.535
/// m.
std::string EncodeDepthPng(const DepthImage& image);

/// The depth image of a 16-bit grey PNG, as EncodeDepthPng() or a sensor's driver writes them: 0 is
/// no depth, and becomes infinity; every link is -1, every label kOther.
///
/// @param metres_per_unit 0.001 for millimetres.
/// @param name Of the picture, for messages.
/// @throws Error(kFormat) unless it is such a PNG of at most 8192 pixels a side.
DepthImage DecodeDepthPng(std::string_view bytes, double metres_per_unit, const std::string& name);

/// What numbers of depth are worth [m].
struct DepthUnits {
  double of_float = 1;
  double of_integer = 0.001;
};

/// The depth image of an array as NumPy's save() writes it: two axes, rows and columns (a third of
/// length 1 is taken), of `<f4` or `<f8`, whose holes are NaN, infinite or 0, or of `<u2`.
///
/// @throws Error(kFormat) unless it is such an array of at most 8192 pixels a side.
DepthImage DecodeDepthNpy(std::string_view bytes, const DepthUnits& units, const std::string& name);

/// A depth image of numbers in memory [m], such as a driver's; what is not above 0 and finite
/// becomes infinity, no depth. Every link is -1, every label kOther.
///
/// @throws Error(kInvalidArgument) unless there are width x height numbers.
DepthImage MakeDepthImage(int width, int height, std::vector<float> depth_m);

/// A picture of a PNG (grey or colours, with or without alpha, which is dropped) or JPEG file.
///
/// @throws Error(kFormat) unless it is one of at most 8192 pixels a side.
Picture DecodePicture(std::string_view bytes, const std::string& name);

/// Which pixels belong to something, row by row from the top left.
struct PixelMask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> set;  ///< 1 or 0.
};

/// Reads a grey PNG of 8 or 16 bits: every pixel that is not 0 is set.
///
/// @throws Error(kFormat) unless it is such a PNG of at most 8192 pixels a side.
PixelMask DecodeMaskPng(std::string_view bytes, const std::string& name);
/// 8-bit grey PNG, 255 where the mask is set. Throws Error(kInvalidArgument) on an empty mask.
std::string EncodeMaskPng(const PixelMask& mask);

/// EncodePng() or EncodeDepthPng() committed to a file (see core/committed_file.h).
void WritePng(const std::filesystem::path& path, const Picture& picture);
void WriteDepthPng(const std::filesystem::path& path, const DepthImage& image);

/// Depth as colours, near yellow to far violet (viridis) between the nearest and the farthest
/// pixel seen, at most `max_depth_m`; what is beyond or not seen is light grey.
Picture DepthPreview(const DepthImage& image, double max_depth_m = 2.5);

/// Pictures side by side, row by row, each scaled to fit a tile of the given size and centred on
/// white, with its caption (ASCII) below, in as many lines as the tile's width asks for;
/// `captions` is empty or as long as `pictures`.
struct ContactSheetConfig {
  int columns = 4;
  int tile_width = 320;
  int tile_height = 240;
};
Picture ContactSheet(std::span<const Picture> pictures, std::span<const std::string> captions,
                     const ContactSheetConfig& config = {});

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "png_pixels.h"

namespace doorforge::internal {

/// A baseline JPEG (ITU-T T.81) of the pixels, in which colours have half the brightness's
/// resolution. The same pixels give the same bytes on a machine. Empty where it cannot be made.
///
/// @param pixels Of three channels of 8 bits; not empty, and at most 65,500 along a side.
/// @param quality 1 to 100, libjpeg's scale.
std::string EncodeJpegPixels(const PngPixels& pixels, int quality);

struct JpegExtent {
  std::size_t width = 0;
  std::size_t height = 0;
};

/// What a file says of its size; 0 where it says nothing. Prints nothing.
JpegExtent JpegSize(std::string_view jpeg);

/// Decodes into rows of red, green, blue of 8 bits, for which there is room. Returns false where
/// the file is damaged, cut off or of another size. Prints nothing.
bool DecodeJpegColors(std::string_view jpeg, unsigned char* pixels, const JpegExtent& size);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "png_pixels.h"

namespace doorforge::internal {

/// A baseline JPEG (ITU-T T.81) of the pixels, in which colours have half the brightness's
/// resolution. The same pixels give the same bytes on a machine. Empty where it cannot be made.
///
/// @param pixels Of three channels of 8 bits; not empty, and at most 65,500 along a side.
/// @param quality 1 to 100, libjpeg's scale.
std::string EncodeJpegPixels(const PngPixels& pixels, int quality);

}  // namespace doorforge::internal

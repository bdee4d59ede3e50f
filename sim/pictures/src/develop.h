// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "appearance.h"
#include "finish.h"

namespace doorforge {

/// Spreads each pixel over its neighbours, by less than a pixel: Exposure::blur_px.
///
/// @param colors Height rows of `width` pixels, at least one.
void BlurPicture(std::vector<LinearColor>& colors, int width, const Exposure& exposure);

/// What a camera makes of light: gain and white balance, noise that grows with the root of the
/// light, a soft end to bright light, sRGB.
///
/// @param seed Names the noise.
/// @return Three bytes a pixel.
std::vector<std::uint8_t> DevelopPicture(const std::vector<LinearColor>& colors,
                                         const Exposure& exposure, std::uint32_t seed);

}  // namespace doorforge

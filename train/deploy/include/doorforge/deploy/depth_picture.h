// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "doorforge/deploy/calibrated_camera.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

/// The median of the depths that were measured [m], of a large picture of some 20,000 of them;
/// nothing if none was.
std::optional<double> MedianDepth(const DepthImage& depth);

/// Throws Error(kInvalidArgument) where half of the depths are nearer than 5 cm or farther than
/// 30 m, which is what a wrong unit makes of them: with the median, what it was read as, and the
/// unit that makes a room of it.
///
/// @param read_as Such as "in metres".
void RequirePlausibleDepths(const DepthImage& depth, const std::string& read_as);

/// Reads a depth picture as cameras' programs write them: a grey PNG of 16 bits, or an array of
/// NumPy's (DecodeDepthNpy()), in the camera's units.
///
/// @throws Error(kMissing), Error(kFormat) naming the file, and what to do with a TIFF or EXR;
///     Error(kInvalidArgument) as RequirePlausibleDepths().
DepthImage ReadDepthPicture(const std::filesystem::path& path, const CalibratedCamera& camera);

/// Reads a mask as DecodeMaskPng() does. Throws Error(kMissing), and as it.
PixelMask ReadMaskPicture(const std::filesystem::path& path);

/// Reads a picture in colours that shows pixel by pixel what the depth shows, and keeps it as the
/// depth's; nothing is done for an empty path.
///
/// @throws Error(kMissing), Error(kFormat) naming the file; Error(kInvalidArgument) if it has
///     another size than the depth, which depth that was registered to it would have.
void AddColors(const std::filesystem::path& path, DepthImage& depth);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "doorforge/view/view_page.h"

namespace doorforge {

/// How a gallery is drawn.
struct GalleryConfig {
  int threads = 0;         ///< 0: all processors; no byte depends on it.
  int thumbnail_px = 240;  ///< Width of a thumbnail, 64 to 640; its height is three quarters.
};

/// Shows the doors and parts in the folders with a picture of body and handle each, filters, their
/// ids, and each in 3D with its latch, without collision shapes and findings. What is alike is
/// drawn and kept once: 10,217 doors are 532 pictures. A record that cannot be read, or that lacks
/// a mesh, is left out with its fault.
///
/// @throws Error(kInvalidArgument) if the width is out of range; Error(kFormat) if none of the
/// records
///     can be read; Error(kMissing) where the viewer is not among the data.
ViewPage MakeGalleryPage(std::span<const std::filesystem::path> folders,
                         const GalleryConfig& config = {});

}  // namespace doorforge

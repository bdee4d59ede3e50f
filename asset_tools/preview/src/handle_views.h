// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {

/// A handle and what it is on, all in one frame whose x points out of the door and z up.
struct HandleScene {
  std::vector<VisibleMesh> handle;
  std::vector<VisibleMesh> leaf;  ///< May be empty.
};

/// A picture and the line below it.
struct CaptionedPicture {
  Picture picture;
  std::string side;  ///< "front", "side", "above".
  std::string caption;
};

/// The handle alone, large: from the front, from the side and from above, as good as without
/// perspective, with the leaf around it cut off. Each holds a bar of 50 mm in steps of 10 and the
/// three axes: x red, y green, z blue. Empty where the handle has no vertex.
std::vector<CaptionedPicture> HandleViews(const HandleScene& scene, int width, int height);

}  // namespace doorforge

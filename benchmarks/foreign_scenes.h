// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/core/rng.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/pinhole_view.h"

namespace doorforge::benchmark {

/// A picture with its labels, and the camera that whoever reads it believes in.
struct Shot {
  std::string kind;
  DepthImage depth;
  PinholeView view;
};

/// What a camera may show in the place of this sound picture: walls, rooms without a door, noise,
/// the picture upside down, and the picture read with a wrong camera file. Where a kind has the
/// robot, it stands before the rest as it did.
std::vector<Shot> ForeignShots(const DepthImage& sound, const PinholeView& view, Rng& rng);

/// Does what ForeignShots() does for the closed door before the robot comes into view, with the
/// handle's mask in the label; the mask stays where it was, and one kind has it on the leaf above
/// the handle.
std::vector<Shot> ForeignLooks(const DepthImage& sound, const PinholeView& view, Rng& rng);

}  // namespace doorforge::benchmark

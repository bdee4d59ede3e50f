// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Knows the colours of what a scene's camera sees. Serves one thread at a time.
class ColorSource {
 public:
  virtual ~ColorSource() = default;
  /// sRGB of every pixel, height x width x 3.
  ///
  /// @param look Number of the look, counted from 0: the noise of its colours is named by it.
  virtual std::vector<std::uint8_t> ColorsAt(const SceneSnapshot& snapshot, int look) = 0;
};

/// Makes the source for a scene's camera. False: the robot is not there.
using ColorSources =
    std::function<std::unique_ptr<ColorSource>(const Scene& scene, bool sees_robot)>;

}  // namespace doorforge

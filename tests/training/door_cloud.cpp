// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "door_cloud.h"

#include <cmath>

#include "doorforge/core/rng.h"

namespace doorforge::testing {

std::vector<float> DoorCloud(std::uint64_t seed, double hinge_rad) {
  Rng rng(seed, "test/door_cloud");
  std::vector<float> xyz;
  const double c = std::cos(hinge_rad);
  const double s = std::sin(hinge_rad);
  for (int i = 0; i < 4096; ++i) {
    double along = 0;  // from the hinge
    double out = 0;
    double up = 0;
    const double part = i == 0 ? 1.0 : rng.Uniform();
    const bool frame = part < 0.3;
    if (frame) {
      along = rng.Uniform() < 0.5 ? rng.Uniform(-0.6, -0.1) : rng.Uniform(0.9, 1.4);
      up = rng.Uniform(0, 2.2);
    } else if (part < 0.9) {
      along = rng.Uniform(0, 0.9);
      up = rng.Uniform(0, 2);
    } else {
      along = rng.Uniform(0.75, 0.85);
      out = rng.Uniform(0.03, 0.06);
      up = rng.Uniform(0.95, 1.05);
    }
    const double x = frame ? 0 : out * c + along * s;
    const double y = frame ? along : along * c - out * s;
    for (const double v : {x, y - 0.4, up})
      xyz.push_back(static_cast<float>(v + 0.002 * rng.Normal()));
  }
  return xyz;
}

}  // namespace doorforge::testing

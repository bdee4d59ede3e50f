// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "synthetic_samples.h"

#include <cmath>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"

#include "door_cloud.h"

namespace doorforge::testing {
namespace {

TrainingSample MakeSample(double hinge_rad, Rng& rng) {
  const double c = std::cos(hinge_rad);
  const double s = std::sin(hinge_rad);
  TrainingSample sample;
  Proprioception& proprioception = sample.proprioception;
  for (const std::size_t first : {0U, 11U}) {  // positions and velocities of sliders and arm
    for (std::size_t i = first; i < first + 9; ++i)
      proprioception[i] = static_cast<float>(0.1 * rng.Normal());
  }
  proprioception[0] = static_cast<float>(hinge_rad + 0.05 * rng.Normal());
  const std::array<double, 10> poses = {
      0.7 + 0.1 * rng.Normal(), 0, 0.1, 0.8 * s, 0.8 * c - 0.4, 1.0, 0, 0, 0, 1};
  std::copy(poses.begin(), poses.end(), proprioception.begin() + 22);
  Action action;
  action.position_delta_m = {0.06 * c, -0.06 * s, 0.0};
  action.world_from_hand_rotation = RotationAbout(Eigen::Vector3d::UnitZ(), -hinge_rad).linear() *
                                    RotationAbout(Eigen::Vector3d::UnitY(), 3.14159).linear();
  sample.action = ToVector(action);
  sample.executed = sample.action;
  sample.executed[1] += 0.004F;
  sample.angle_gain_rad = static_cast<float>(0.05 + 0.02 * s);
  return sample;
}

}  // namespace

SyntheticSamples MakeSyntheticSamples(std::uint64_t seed, std::size_t count) {
  SyntheticSamples made;
  Rng rng(seed, "test/synthetic_samples");
  for (std::size_t i = 0; i < count; ++i) {
    const double hinge_rad = rng.Uniform(0, 0.9);
    made.clouds.push_back(DoorCloud(seed * 100000 + i, hinge_rad));
    made.samples.push_back(MakeSample(hinge_rad, rng));
  }
  for (std::size_t i = 0; i < count; ++i) made.samples[i].cloud = made.clouds[i];
  return made;
}

}  // namespace doorforge::testing

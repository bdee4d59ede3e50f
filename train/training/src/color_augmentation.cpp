// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "color_augmentation.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rigid_transform.h"

namespace doorforge::internal {
namespace {

constexpr double kMiddle = 127.5;   // between black and white
constexpr double kBrightness = 64;  // moved by so much at most, of 255

}  // namespace

std::shared_ptr<const CloudGeometry> Recolored(const std::shared_ptr<const CloudGeometry>& geometry,
                                               Rng& rng) {
  const double hue_rad = rng.Uniform(-std::numbers::pi, std::numbers::pi);
  const double contrast = rng.Uniform();
  const double brightness = rng.Uniform(-kBrightness, kBrightness);
  const Eigen::Vector3d grey_axis = Eigen::Vector3d::Ones().normalized();
  const Eigen::Matrix3f turn =
      (contrast * RotationAbout(grey_axis, hue_rad).linear()).cast<float>();
  const Eigen::Vector3f middle = Eigen::Vector3d::Constant(kMiddle).cast<float>();
  const Eigen::Vector3f moved = Eigen::Vector3d::Constant(kMiddle + brightness).cast<float>();
  CloudGeometry recolored = *geometry;
  for (std::size_t i = 0; i + 2 < recolored.rgb.size(); i += 3) {
    Eigen::Map<Eigen::Matrix<std::uint8_t, 3, 1>> color(&recolored.rgb[i]);
    const Eigen::Vector3f changed = turn * (color.cast<float>() - middle) + moved;
    color = changed.cwiseMax(0).cwiseMin(255).array().round().matrix().cast<std::uint8_t>();
  }
  return std::make_shared<const CloudGeometry>(std::move(recolored));
}

void Recolor(const TrainConfig& config, const Minibatch& batch, int threads,
             Geometries& geometries) {
  if (batch.set != SampleSet::kTrain || !config.colors || !config.augment_colors) return;
  ParallelFor(geometries.size(), threads, [&](std::size_t i) {
    Rng rng(config.seed,
            "train/colors/" + std::to_string(batch.step) + "/" + std::to_string(batch.indices[i]));
    geometries[i] = Recolored(geometries[i], rng);
  });
}

}  // namespace doorforge::internal

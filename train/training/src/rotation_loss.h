// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <torch/types.h>

namespace doorforge::internal {

/// Rows x, y, z of the rotations that six numbers stand for (Gram-Schmidt; Zhou et al. 2019).
inline std::array<torch::Tensor, 3> RotationRows(const torch::Tensor& six) {
  const auto normalise = [](const torch::Tensor& v) {
    return v / (v.square().sum(1, true) + 1e-12).sqrt();
  };
  const torch::Tensor x = normalise(six.narrow(1, 0, 3));
  const torch::Tensor second = six.narrow(1, 3, 3);
  const torch::Tensor y = normalise(second - (x * second).sum(1, true) * x);
  return {x, y, torch::cross(x, y, 1)};
}

/// Mean angle between rotations. The angle is 2 asin(|A - B| / sqrt 8): the arc cosine of the trace
/// has no usable gradient at 0, where training ends.
inline torch::Tensor MeanGeodesicAngle(const torch::Tensor& six_a, const torch::Tensor& six_b) {
  const auto a = RotationRows(six_a);
  const auto b = RotationRows(six_b);
  torch::Tensor squared = torch::zeros({six_a.size(0)});
  for (std::size_t i = 0; i < 3; ++i) squared = squared + (a[i] - b[i]).square().sum(1);
  const torch::Tensor half_sine = ((squared + 1e-10) / 8).sqrt().clamp_max(1 - 1e-4);
  return (2 * torch::asin(half_sine)).mean();
}

}  // namespace doorforge::internal

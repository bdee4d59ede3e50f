// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/networks/point_net.h"

// Losses of a PointNet in libtorch; policies run it by PointNet, without it.

namespace doorforge::internal {

/// What a network reads and is to say of n clouds.
struct PointNetBatch {
  int size = 0;                     ///< n.
  std::vector<float> points = {};   ///< n x P x shape.point.
  std::vector<float> own = {};      ///< n x shape.own.
  std::vector<float> targets = {};  ///< n x shape.outputs.
};

/// What is summed over all numbers of a batch.
enum class PointNetError {
  kSquared,       ///< (says - target)^2
  kCrossEntropy,  ///< Binary, of the sigmoid of what it says; targets in [0, 1].
};

struct PointNetLoss {
  PointNetShape shape;
  PointNetError error = PointNetError::kSquared;
};

/// The sum. Adds `weight` times its gradient to `gradient`, a flat vector of PointNetLayout(); an
/// empty one: no gradient.
double PointNetLossOf(const PointNetLoss& loss, std::span<const float> parameters,
                      const PointNetBatch& batch, double weight, std::span<float> gradient);

/// What libtorch makes of a batch: n x shape.outputs, for tests.
std::vector<float> PointNetOutputsOf(const PointNetShape& shape, std::span<const float> parameters,
                                     const PointNetBatch& batch);

}  // namespace doorforge::internal

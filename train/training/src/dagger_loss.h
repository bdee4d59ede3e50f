// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/networks/point_net.h"

// The student's loss in libtorch; it acts by PointNet, without it. Only dagger_loss.cpp sees
// libtorch's headers.

namespace doorforge::internal {

/// What a student reads and is taught at n decisions.
struct DaggerBatch {
  int size = 0;                    ///< n.
  std::vector<float> points = {};  ///< n x P x shape.point.
  std::vector<float> own = {};     ///< n x shape.own.
  std::vector<float> taught = {};  ///< n x shape.outputs.
};

/// Sum of the squared errors over all numbers of all decisions. Adds `weight` times its gradient to
/// `gradient`, a flat vector of PointNetLayout(); an empty one: no gradient.
double DaggerLossOf(const PointNetShape& shape, std::span<const float> parameters,
                    const DaggerBatch& batch, double weight, std::span<float> gradient);

/// What libtorch makes of a batch: n x shape.outputs, for tests.
std::vector<float> DaggerOutputsOf(const PointNetShape& shape, std::span<const float> parameters,
                                   const DaggerBatch& batch);

}  // namespace doorforge::internal

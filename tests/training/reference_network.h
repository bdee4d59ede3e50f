// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "doorforge/networks/parameters.h"

namespace doorforge::testing {

/// Of the weights and activations; indices and positions are those of single precision.
enum class Precision { kSingle, kDouble };

/// The same PointNet++ in stock libtorch operators: padded balls, all centres, all points, its own
/// textbook point operators, and batch normalisation by its formula behind the layers whose layout
/// has one. Shares nothing with the room's encoder but the parameter vector.
class ReferenceNetwork {
 public:
  /// `clouds`: each 4096 x 3; `centre` is subtracted.
  ReferenceNetwork(const ParameterLayout& layout, std::span<const float> parameters,
                   const std::vector<std::vector<float>>& clouds,
                   const std::array<float, 3>& centre, Precision precision);
  ~ReferenceNetwork();

  struct Result {
    std::vector<float> features;  ///< Clouds x 4096 x 128.
    std::vector<float> gradient;  ///< Of sum(feature_gradient * features), as the parameters.
    /// Of the normalised layers, in the layout's order: means, biased variances, and the number of
    /// rows that each is of.
    std::vector<float> mean, variance;
    std::vector<double> rows;
  };
  /// `feature_gradient`: clouds x 4096 x 128.
  Result Run(std::span<const float> feature_gradient);

 private:
  struct Tensors;
  std::unique_ptr<Tensors> tensors_;
};

}  // namespace doorforge::testing

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/parameters.h"

#include <cmath>

#include "doorforge/core/rng.h"

namespace doorforge {

std::size_t ParameterLayout::Add(const std::string& name, int inputs, int outputs) {
  layers_.push_back({name, inputs, outputs, size()});
  return layers_.size() - 1;
}

std::vector<float> HeInitialisation(const ParameterLayout& layout, std::uint64_t seed,
                                    const std::string& prefix) {
  std::vector<float> parameters(layout.size());
  for (const DenseLayer& layer : layout.layers()) {
    Rng rng(seed, "init/" + prefix + layer.name);
    const double deviation = std::sqrt(2.0 / layer.inputs);
    for (std::size_t i = layer.offset; i < layer.bias_offset(); ++i)
      parameters[i] = static_cast<float>(deviation * rng.Normal());
  }
  return parameters;
}

}  // namespace doorforge

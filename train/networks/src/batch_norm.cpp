// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/batch_norm.h"

#include <cmath>

namespace doorforge {
namespace {

void Move(std::span<const float> batch, std::span<float> running) {
  for (std::size_t i = 0; i < running.size(); ++i)
    running[i] += kNormMomentum * (batch[i] - running[i]);
}

}  // namespace

const DenseLayer* NormBehind(const ParameterLayout& layout, std::size_t layer) {
  const std::vector<DenseLayer>& layers = layout.layers();
  const bool normalised =
      layer + 1 < layers.size() && layers[layer + 1].name == layers[layer].name + ".norm";
  return normalised ? &layers[layer + 1] : nullptr;
}

LayerStatistics InitialStatistics(const ParameterLayout& layout) {
  LayerStatistics statistics;
  for (std::size_t i = 0; i < layout.layers().size(); ++i) {
    const DenseLayer* norm = NormBehind(layout, i);
    if (norm == nullptr) continue;
    const std::size_t outputs = norm->weight_count();
    statistics.mean.insert(statistics.mean.end(), outputs, 0.0F);
    statistics.variance.insert(statistics.variance.end(), outputs, 1.0F);
  }
  return statistics;
}

void MoveTowards(const LayerStatistics& batch, LayerStatistics& running) {
  Move(batch.mean, running.mean);
  Move(batch.variance, running.variance);
}

std::vector<float> FoldNorms(const ParameterLayout& layout, std::span<const float> parameters,
                             const LayerStatistics& running) {
  std::vector<float> folded;
  std::size_t statistic = 0;
  for (std::size_t i = 0; i < layout.layers().size(); ++i) {
    const DenseLayer& layer = layout.layers()[i];
    const auto begin = static_cast<std::ptrdiff_t>(folded.size());
    folded.insert(folded.end(), parameters.begin() + static_cast<std::ptrdiff_t>(layer.offset),
                  parameters.begin() + static_cast<std::ptrdiff_t>(layer.end()));
    const DenseLayer* norm = NormBehind(layout, i);
    if (norm == nullptr) continue;
    float* weight = folded.data() + begin;
    float* bias = weight + layer.weight_count();
    for (std::size_t o = 0; o < norm->weight_count(); ++o, ++statistic) {
      const float factor =
          parameters[norm->offset + o] / std::sqrt(running.variance[statistic] + kNormEpsilon);
      for (int k = 0; k < layer.inputs; ++k) *weight++ *= factor;
      bias[o] = parameters[norm->bias_offset() + o] - factor * running.mean[statistic];
    }
    ++i;  // the normalisation itself
  }
  return folded;
}

}  // namespace doorforge

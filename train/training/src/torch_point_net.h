// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <torch/types.h>

#include "doorforge/networks/point_net.h"

// PointNet as training needs it, in libtorch. Only sources that compute losses include it.

namespace doorforge::internal {

/// Shares the memory of `values`, row after row.
inline torch::Tensor BatchTensor(const std::vector<float>& values, int columns) {
  return torch::from_blob(const_cast<float*>(values.data()),
                          {static_cast<std::int64_t>(values.size()) / columns, columns});
}

/// Dense layers whose tensors share a flat vector's memory.
class TorchLayers {
 public:
  TorchLayers(const ParameterLayout& layout, std::span<const float> parameters, bool learns) {
    auto* data = const_cast<float*>(parameters.data());
    for (const DenseLayer& layer : layout.layers()) {
      tensors_.push_back(torch::from_blob(data + layer.offset, {layer.outputs, layer.inputs})
                             .set_requires_grad(learns));
      tensors_.push_back(
          torch::from_blob(data + layer.bias_offset(), {layer.outputs}).set_requires_grad(learns));
    }
  }

  /// What the layer of this place in the layout makes of rows.
  torch::Tensor Dense(std::size_t layer, const torch::Tensor& x) const {
    return torch::addmm(tensors_[2 * layer + 1], x, tensors_[2 * layer].t());
  }

  /// Adds what backward() found to `gradient`, a flat vector of the layout.
  void AddGradient(std::span<float> gradient) const {
    std::size_t at = 0;
    for (const torch::Tensor& tensor : tensors_) {
      const torch::Tensor grad = tensor.grad().contiguous();
      const float* values = grad.data_ptr<float>();
      for (std::int64_t i = 0; i < grad.numel(); ++i) gradient[at++] += values[i];
    }
  }

 private:
  std::vector<torch::Tensor> tensors_;  // weight and bias in turn
};

/// A PointNet whose tensors share the flat vector's memory.
class TorchPointNet {
 public:
  TorchPointNet(const PointNetShape& shape, std::span<const float> parameters, bool learns)
      : shape_(shape), layers_(PointNetLayout(shape), parameters, learns) {}

  /// The features of n clouds whose points follow each other, n x cloud_features.
  torch::Tensor CloudFeatures(const torch::Tensor& points, std::int64_t n) const {
    return torch::relu(Dense(3, torch::relu(Dense(2, Pooled(points, n)))));
  }

  torch::Tensor Outputs(const torch::Tensor& cloud_features, const torch::Tensor& own) const {
    torch::Tensor x = torch::cat({cloud_features, own}, 1);
    for (const std::size_t layer : {4U, 5U, 6U}) x = torch::elu(Dense(layer, x));
    return Dense(7, x);
  }

  void AddGradient(std::span<float> gradient) const { layers_.AddGradient(gradient); }

 private:
  torch::Tensor Dense(std::size_t layer, const torch::Tensor& x) const {
    return layers_.Dense(layer, x);
  }

  torch::Tensor Features(const torch::Tensor& points) const {
    return torch::relu(Dense(1, torch::relu(Dense(0, points))));
  }

  // Most points win no maximum and have no gradient: who does is found first, and the graph is that
  // of the winners alone.
  torch::Tensor Pooled(const torch::Tensor& points, std::int64_t n) const {
    torch::Tensor winner;
    torch::Tensor rows;
    {
      const at::AutoGradMode off(false);
      const torch::Tensor all = Features(points).view({n, -1, shape_.point_features});
      const torch::Tensor of_cloud = all.argmax(1);  // n x features
      const torch::Tensor begin = torch::arange(n).unsqueeze(1) * all.size(1);
      std::tie(rows, winner) = at::_unique(of_cloud + begin, /*sorted=*/true,
                                           /*return_inverse=*/true);
    }
    return Features(points.index_select(0, rows)).gather(0, winner);
  }

  PointNetShape shape_;
  TorchLayers layers_;
};

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dagger_loss.h"

#include <torch/types.h>

#include "head_objectives.h"

namespace doorforge::internal {
namespace {

// Shares the memory of `values`, row after row.
torch::Tensor BatchTensor(const std::vector<float>& values, int columns) {
  return torch::from_blob(const_cast<float*>(values.data()),
                          {static_cast<std::int64_t>(values.size()) / columns, columns});
}

// A student whose tensors share the flat vector's memory.
class TorchPointNet {
 public:
  TorchPointNet(const PointNetShape& shape, std::span<const float> parameters, bool learns)
      : shape_(shape) {
    auto* data = const_cast<float*>(parameters.data());
    const ParameterLayout layout = PointNetLayout(shape);
    for (const DenseLayer& layer : layout.layers()) {
      tensors_.push_back(torch::from_blob(data + layer.offset, {layer.outputs, layer.inputs})
                             .set_requires_grad(learns));
      tensors_.push_back(
          torch::from_blob(data + layer.bias_offset(), {layer.outputs}).set_requires_grad(learns));
    }
  }

  torch::Tensor operator()(const DaggerBatch& batch) const {
    const std::int64_t n = batch.size;
    const torch::Tensor points = BatchTensor(batch.points, shape_.point);
    const torch::Tensor pooled = Pooled(points, n);
    const torch::Tensor seen = torch::relu(Dense(3, torch::relu(Dense(2, pooled))));
    torch::Tensor x = torch::cat({seen, BatchTensor(batch.own, shape_.own)}, 1);
    for (const std::size_t layer : {4U, 5U, 6U}) x = torch::elu(Dense(layer, x));
    return Dense(7, x);
  }

  void AddGradient(std::span<float> gradient) const {
    std::size_t at = 0;
    for (const torch::Tensor& tensor : tensors_) {
      const torch::Tensor grad = tensor.grad().contiguous();
      const float* values = grad.data_ptr<float>();
      for (std::int64_t i = 0; i < grad.numel(); ++i) gradient[at++] += values[i];
    }
  }

 private:
  torch::Tensor Dense(std::size_t layer, const torch::Tensor& x) const {
    return torch::addmm(tensors_[2 * layer + 1], x, tensors_[2 * layer].t());
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
  std::vector<torch::Tensor> tensors_;  // weight and bias in turn
};

}  // namespace

double DaggerLossOf(const PointNetShape& shape, std::span<const float> parameters,
                    const DaggerBatch& batch, double weight, std::span<float> gradient) {
  UseOneTorchThread();  // the setting is each thread's own
  const at::AutoGradMode mode(!gradient.empty());
  const TorchPointNet student(shape, parameters, !gradient.empty());
  const torch::Tensor taught = BatchTensor(batch.taught, shape.outputs);
  const torch::Tensor loss = (student(batch) - taught).square().sum();
  if (!gradient.empty()) {
    (weight * loss).backward();
    student.AddGradient(gradient);
  }
  return loss.item<double>();
}

std::vector<float> DaggerOutputsOf(const PointNetShape& shape, std::span<const float> parameters,
                                   const DaggerBatch& batch) {
  const at::AutoGradMode mode(false);
  const torch::Tensor out = TorchPointNet(shape, parameters, false)(batch).contiguous();
  return {out.data_ptr<float>(), out.data_ptr<float>() + out.numel()};
}

}  // namespace doorforge::internal

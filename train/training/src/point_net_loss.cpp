// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "point_net_loss.h"

#include <torch/types.h>

#include "head_objectives.h"
#include "torch_point_net.h"

namespace doorforge::internal {
namespace {

torch::Tensor OutputsOf(const TorchPointNet& network, const PointNetShape& shape,
                        const PointNetBatch& batch) {
  return network.Outputs(network.CloudFeatures(BatchTensor(batch.points, shape.point), batch.size),
                         BatchTensor(batch.own, shape.own));
}

// Summed over all numbers.
torch::Tensor ErrorOf(PointNetError error, const torch::Tensor& says, const torch::Tensor& target) {
  if (error == PointNetError::kCrossEntropy)
    return torch::binary_cross_entropy_with_logits(says, target, {}, {}, at::Reduction::Sum);
  return (says - target).square().sum();
}

}  // namespace

double PointNetLossOf(const PointNetLoss& loss, std::span<const float> parameters,
                      const PointNetBatch& batch, double weight, std::span<float> gradient) {
  UseOneTorchThread();  // the setting is each thread's own
  const at::AutoGradMode mode(!gradient.empty());
  const TorchPointNet network(loss.shape, parameters, !gradient.empty());
  const torch::Tensor found = ErrorOf(loss.error, OutputsOf(network, loss.shape, batch),
                                      BatchTensor(batch.targets, loss.shape.outputs));
  if (!gradient.empty()) {
    (weight * found).backward();
    network.AddGradient(gradient);
  }
  return found.item<double>();
}

std::vector<float> PointNetOutputsOf(const PointNetShape& shape, std::span<const float> parameters,
                                     const PointNetBatch& batch) {
  const at::AutoGradMode mode(false);
  const torch::Tensor out =
      OutputsOf(TorchPointNet(shape, parameters, false), shape, batch).contiguous();
  return {out.data_ptr<float>(), out.data_ptr<float>() + out.numel()};
}

}  // namespace doorforge::internal

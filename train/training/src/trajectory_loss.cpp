// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "trajectory_loss.h"

#include <torch/types.h>

#include "head_objectives.h"
#include "rotation_loss.h"
#include "torch_point_net.h"

namespace doorforge::internal {
namespace {

constexpr std::int64_t kRotationNumbers = 6;

/// Decoder and encoder of the autoencoder.
class Autoencoder {
 public:
  Autoencoder(const TrajectoryShape& shape, std::span<const float> parameters, bool learns)
      : shape_(shape),
        decoder_size_(PointNetLayout(ProposerShape(shape)).size()),
        decoder_(ProposerShape(shape), parameters.first(decoder_size_), learns),
        encoder_(PosteriorLayout(shape), parameters.subspan(decoder_size_), learns) {}

  torch::Tensor Loss(const ProposerBatch& batch, const ProposerWeights& weights) const {
    const torch::Tensor targets = BatchTensor(batch.targets, kTargetNumbers);
    const int numbers = TrajectoryNumbers(shape_.waypoints);
    const torch::Tensor wanted = BatchTensor(batch.trajectory, numbers);
    const torch::Tensor seen =
        decoder_.CloudFeatures(BatchTensor(batch.points, kDoorPoint), batch.size);
    const torch::Tensor code = Encoded(torch::cat({seen, targets, wanted}, 1));
    const torch::Tensor mean = code.narrow(1, 0, shape_.latent);
    const torch::Tensor log_variance = code.narrow(1, shape_.latent, shape_.latent);
    const torch::Tensor latent =
        mean + (0.5 * log_variance).exp() * BatchTensor(batch.noise, shape_.latent);
    const torch::Tensor says = decoder_.Outputs(seen, torch::cat({targets, latent}, 1));
    const std::int64_t waypoints = numbers - kRotationNumbers;
    const torch::Tensor apart = (says.narrow(1, kRotationNumbers, waypoints) -
                                 wanted.narrow(1, kRotationNumbers, waypoints))
                                    .abs()
                                    .mean(1)
                                    .sum();
    const torch::Tensor turned = MeanGeodesicAngle(says.narrow(1, 0, kRotationNumbers),
                                                   wanted.narrow(1, 0, kRotationNumbers)) *
                                 static_cast<double>(batch.size);
    const torch::Tensor divergence =
        (0.5 * (mean.square() + log_variance.exp() - 1 - log_variance)).sum();
    return weights.waypoints * apart + weights.rotation * turned + weights.latent * divergence;
  }

  void AddGradient(std::span<float> gradient) const {
    decoder_.AddGradient(gradient.first(decoder_size_));
    encoder_.AddGradient(gradient.subspan(decoder_size_));
  }

 private:
  torch::Tensor Encoded(const torch::Tensor& x) const {
    const torch::Tensor hidden = torch::elu(encoder_.Dense(0, x));
    return encoder_.Dense(2, torch::elu(encoder_.Dense(1, hidden)));
  }

  TrajectoryShape shape_;
  std::size_t decoder_size_;
  TorchPointNet decoder_;
  TorchLayers encoder_;
};

}  // namespace

double ProposerLossOf(const TrajectoryShape& shape, std::span<const float> parameters,
                      const ProposerBatch& batch, const ProposerWeights& weights, double weight,
                      std::span<float> gradient) {
  UseOneTorchThread();  // the setting is each thread's own
  const at::AutoGradMode mode(!gradient.empty());
  const Autoencoder networks(shape, parameters, !gradient.empty());
  const torch::Tensor loss = networks.Loss(batch, weights);
  if (!gradient.empty()) {
    (weight * loss).backward();
    networks.AddGradient(gradient);
  }
  return loss.item<double>();
}

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "ppo_loss.h"

#include <cmath>
#include <numbers>

#include <torch/types.h>

namespace doorforge::internal {
namespace {

const double kHalfLogTwoPi = 0.5 * std::log(2 * std::numbers::pi);

torch::Tensor MatrixOf(const std::vector<float>& values, std::size_t rows) {
  const auto count = static_cast<std::int64_t>(rows);
  return torch::from_blob(const_cast<float*>(values.data()),
                          {count, static_cast<std::int64_t>(values.size()) / count});
}

torch::Tensor ColumnOf(const std::vector<float>& values) {
  return torch::from_blob(const_cast<float*>(values.data()),
                          {static_cast<std::int64_t>(values.size())});
}

// A small network whose tensors share the flat vector's memory.
class TorchMlp {
 public:
  TorchMlp(const MlpShape& shape, const std::vector<float>& parameters) {
    float* data = const_cast<float*>(parameters.data());
    const ParameterLayout layout = MlpLayout(shape);
    for (const DenseLayer& layer : layout.layers()) {
      parameters_.push_back(torch::from_blob(data + layer.offset, {layer.outputs, layer.inputs})
                                .set_requires_grad(true));
      parameters_.push_back(
          torch::from_blob(data + layer.bias_offset(), {layer.outputs}).set_requires_grad(true));
    }
  }

  torch::Tensor operator()(const torch::Tensor& x) const {
    const torch::Tensor first = torch::tanh(Dense(0, x));
    const torch::Tensor second = torch::tanh(Dense(1, first));
    return Dense(2, second);
  }

  void AppendGradient(std::vector<float>& gradient) const {
    for (const torch::Tensor& parameter : parameters_) {
      const torch::Tensor grad = parameter.grad().contiguous();
      gradient.insert(gradient.end(), grad.data_ptr<float>(),
                      grad.data_ptr<float>() + grad.numel());
    }
  }

 private:
  torch::Tensor Dense(std::size_t layer, const torch::Tensor& x) const {
    return torch::addmm(parameters_[2 * layer + 1], x, parameters_[2 * layer].t());
  }

  std::vector<torch::Tensor> parameters_;  // weight and bias in turn
};

torch::Tensor LogProbabilities(const torch::Tensor& actions, const torch::Tensor& mean,
                               const torch::Tensor& log_deviation) {
  const torch::Tensor scaled = (actions - mean) * (-log_deviation).exp();
  return (-0.5 * scaled.square() - log_deviation - kHalfLogTwoPi).sum(1);
}

torch::Tensor PolicyLoss(const torch::Tensor& ratio, const torch::Tensor& advantage, double clip) {
  return -torch::min(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean();
}

torch::Tensor ValueLoss(const torch::Tensor& value, const PpoBatch& batch, double clip) {
  const torch::Tensor returns = ColumnOf(batch.returns);
  const torch::Tensor error = (value - returns).square();
  if (clip <= 0) return 0.5 * error.mean();
  const torch::Tensor before = ColumnOf(batch.values);
  const torch::Tensor near = before + (value - before).clamp(-clip, clip);
  return 0.5 * torch::max(error, (near - returns).square()).mean();
}

}  // namespace

double LogProbability(std::span<const float> action, std::span<const float> mean,
                      std::span<const float> log_deviation) {
  double sum = 0;
  for (std::size_t i = 0; i < action.size(); ++i) {
    const double scaled =
        (double{action[i]} - double{mean[i]}) * std::exp(-double{log_deviation[i]});
    sum += -0.5 * scaled * scaled - double{log_deviation[i]} - kHalfLogTwoPi;
  }
  return sum;
}

PpoLoss PpoLossOf(const PpoNetworks& networks, const PpoBatch& batch, const PpoConfig& config) {
  const at::AutoGradMode mode(true);
  const TorchMlp actor(networks.actor_shape, networks.actor);
  const TorchMlp critic(networks.critic_shape, networks.critic);
  const torch::Tensor log_deviation = ColumnOf(networks.log_deviation).set_requires_grad(true);
  const torch::Tensor observations = MatrixOf(batch.observations, batch.size());

  const torch::Tensor log_ratio =
      LogProbabilities(MatrixOf(batch.actions, batch.size()), actor(observations), log_deviation) -
      ColumnOf(batch.log_probabilities);
  const torch::Tensor ratio = log_ratio.exp();
  const torch::Tensor policy = PolicyLoss(ratio, ColumnOf(batch.advantages), config.clip);
  const torch::Tensor value = ValueLoss(critic(observations).squeeze(1), batch, config.value_clip);
  const torch::Tensor entropy = (log_deviation + (0.5 + kHalfLogTwoPi)).sum();
  (policy + config.value * value - config.entropy * entropy).backward();

  PpoLoss loss;
  loss.policy = policy.item<double>();
  loss.value = value.item<double>();
  loss.entropy = entropy.item<double>();
  loss.kl = ((ratio - 1) - log_ratio).mean().item<double>();
  loss.clipped = ((ratio - 1).abs() > config.clip).to(torch::kFloat32).mean().item<double>();
  actor.AppendGradient(loss.gradient);
  const torch::Tensor spread = log_deviation.grad().contiguous();
  loss.gradient.insert(loss.gradient.end(), spread.data_ptr<float>(),
                       spread.data_ptr<float>() + spread.numel());
  critic.AppendGradient(loss.gradient);
  return loss;
}

}  // namespace doorforge::internal

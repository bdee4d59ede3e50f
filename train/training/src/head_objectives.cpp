// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "head_objectives.h"

#include <algorithm>
#include <string>
#include <utility>

#include <ATen/Parallel.h>
#include <torch/types.h>

#include "doorforge/core/error.h"
#include "doorforge/networks/point_encoder.h"

#include "rotation_loss.h"

namespace doorforge::internal {
namespace {

constexpr double kLeakySlope = 0.01;
constexpr std::int64_t kNearFeatures = 128;

torch::Tensor View(const std::vector<float>& values, std::int64_t columns) {
  return torch::from_blob(const_cast<float*>(values.data()),
                          {static_cast<std::int64_t>(values.size()) / columns, columns});
}

template <std::size_t N>
torch::Tensor Row(const std::array<float, N>& values) {
  return torch::from_blob(const_cast<float*>(values.data()), {1, static_cast<std::int64_t>(N)})
      .clone();
}

template <std::size_t N>
torch::Tensor Denormalise(const Normaliser<N>& normaliser, const torch::Tensor& value) {
  return value * Row(normaliser.deviation) + Row(normaliser.mean);
}

enum class Activation { kNone, kLeaky, kRectified };

torch::Tensor Activate(Activation activation, const torch::Tensor& x) {
  if (activation == Activation::kLeaky) return torch::leaky_relu(x, kLeakySlope);
  return activation == Activation::kRectified ? torch::relu(x) : x;
}

// The parameters of one network as tensors that share the flat vector's memory.
class HeadParameters {
 public:
  HeadParameters(const ParameterLayout& layout, const std::vector<float>& parameters,
                 bool with_gradient)
      : layout_(layout) {
    for (const DenseLayer& layer : layout.layers()) {
      float* data = const_cast<float*>(parameters.data());
      weights_.push_back(torch::from_blob(data + layer.offset, {layer.outputs, layer.inputs})
                             .set_requires_grad(with_gradient));
      biases_.push_back(torch::from_blob(data + layer.bias_offset(), {layer.outputs})
                            .set_requires_grad(with_gradient));
    }
  }

  torch::Tensor Dense(const std::string& name, const torch::Tensor& x) const {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (layout_.layers()[i].name == name) return torch::addmm(biases_[i], x, weights_[i].t());
    }
    throw Error(ErrorCode::kInvalidArgument, "no layer \"" + name + "\" in this network");
  }

  // "<name>.0", "<name>.1", "<name>.2" with the activation between them.
  torch::Tensor Branch(const std::string& name, Activation activation,
                       const torch::Tensor& x) const {
    const torch::Tensor first = Activate(activation, Dense(name + ".0", x));
    const torch::Tensor second = Activate(activation, Dense(name + ".1", first));
    return Dense(name + ".2", second);
  }

  void AddGradient(std::span<float> gradient) const {
    const auto add = [&](const torch::Tensor& tensor, std::size_t offset) {
      if (!tensor.grad().defined()) return;
      const torch::Tensor grad = tensor.grad().contiguous();
      const float* from = grad.data_ptr<float>();
      for (std::int64_t i = 0; i < grad.numel(); ++i)
        gradient[offset + static_cast<std::size_t>(i)] += from[i];
    };
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      add(weights_[i], layout_.layers()[i].offset);
      add(biases_[i], layout_.layers()[i].bias_offset());
    }
  }

 private:
  const ParameterLayout& layout_;
  std::vector<torch::Tensor> weights_;
  std::vector<torch::Tensor> biases_;
};

struct Reconstruction {
  torch::Tensor position;  // mean absolute error of a component [m]
  torch::Tensor rotation;  // mean angle [rad]
};

Reconstruction Compare(const torch::Tensor& decoded, const torch::Tensor& wanted) {
  return {(decoded.narrow(1, 0, 3) - wanted.narrow(1, 0, 3)).abs().mean(),
          MeanGeodesicAngle(decoded.narrow(1, 3, 6), wanted.narrow(1, 3, 6))};
}

class Actor {
 public:
  Actor(const StageNetworks& networks, const HeadParameters& parameters, const HeadBatch& batch,
        const torch::Tensor& features)
      : parameters_(parameters),
        networks_(networks),
        activation_(networks.linear_branches ? Activation::kNone : Activation::kLeaky),
        features_(features),
        state_(parameters_.Branch("state", activation_, View(batch.states, 18))) {}

  // Action numbers in the world's units.
  torch::Tensor Decode(const torch::Tensor& latent) const {
    const torch::Tensor condition = torch::cat({latent, features_, state_}, 1);
    return Denormalise(networks_.normalisation.action,
                       parameters_.Branch("decoder", activation_, condition));
  }

  std::pair<torch::Tensor, torch::Tensor> Posterior(const torch::Tensor& actions) const {
    const torch::Tensor action = parameters_.Branch("action", activation_, actions);
    torch::Tensor hidden =
        parameters_.Dense("posterior.0", torch::cat({action, features_, state_}, 1));
    hidden = parameters_.Dense("posterior.1", torch::leaky_relu(hidden, kLeakySlope));
    return {parameters_.Dense("mean", hidden), parameters_.Dense("log_variance", hidden)};
  }

 private:
  const HeadParameters& parameters_;
  const StageNetworks& networks_;
  Activation activation_;
  torch::Tensor features_;
  torch::Tensor state_;
};

torch::Tensor CriticScore(const HeadParameters& parameters, const StageNetworks& networks,
                          const HeadBatch& batch, const torch::Tensor& features) {
  const auto branch = [&](const char* name, const std::vector<float>& values,
                          std::int64_t columns) {
    return parameters.Branch(name, Activation::kRectified, View(values, columns));
  };
  const torch::Tensor joined =
      torch::cat({features, branch("state", batch.states, 18), branch("action", batch.actions, 9),
                  branch("hand", batch.hands, 3), branch("base", batch.bases, 3)},
                 1);
  return Denormalise(networks.normalisation.angle_gain_rad,
                     parameters.Branch("score", Activation::kRectified, joined));
}

// The two heads of the grasp: two layers of score behind the feature and its branches.
torch::Tensor GraspScore(const HeadParameters& parameters, const StageNetworks& networks,
                         const std::vector<torch::Tensor>& joined) {
  const torch::Tensor hidden = parameters.Dense("score.0", torch::cat(joined, 1));
  return Denormalise(networks.normalisation.angle_gain_rad,
                     parameters.Dense("score.1", torch::leaky_relu(hidden, kLeakySlope)));
}

// The maximum over the near points, feature by feature.
torch::Tensor NearFeatures(const HeadParameters& parameters, const HeadBatch& batch) {
  const torch::Tensor each =
      torch::relu(parameters.Branch("near", Activation::kRectified, View(batch.near, 3)));
  return std::get<0>(each.view({batch.size, -1, kNearFeatures}).max(1));
}

torch::Tensor DiscriminatorScore(const HeadParameters& parameters, const StageNetworks& networks,
                                 const HeadBatch& batch, const torch::Tensor& features) {
  const auto none = [&](std::int64_t columns) { return torch::zeros({batch.size, columns}); };
  if (!batch.near.empty())
    return GraspScore(parameters, networks,
                      {none(kFeatureSize), none(128), NearFeatures(parameters, batch)});
  return GraspScore(
      parameters, networks,
      {features, parameters.Branch("action", Activation::kRectified, View(batch.actions, 9)),
       none(kNearFeatures)});
}

torch::Tensor AffordanceScore(const HeadParameters& parameters, const StageNetworks& networks,
                              const HeadBatch& batch, const torch::Tensor& features) {
  return GraspScore(
      parameters, networks,
      {features, parameters.Branch("point", Activation::kRectified, View(batch.points, 3))});
}

std::vector<float> ToVector(const torch::Tensor& tensor) {
  const torch::Tensor flat = tensor.contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

// What a head gives for a batch: what is minimised, and what is reported.
struct Loss {
  torch::Tensor objective;
  StageLosses losses = {};
};

Loss MeanAbsolute(const torch::Tensor& score, const HeadBatch& batch,
                  std::optional<double> StageLosses::*reported) {
  Loss loss{(score - View(batch.angle_gains_rad, 1)).abs().mean()};
  loss.losses.*reported = loss.objective.item<double>();
  return loss;
}

// A network's values and where its gradient goes; empty: none is wanted.
struct Head {
  const ParameterLayout& layout;
  const std::vector<float>& values;
  std::span<float> gradient;
};

// `loss_of(parameters, features)` and, where a gradient is wanted, the way back.
template <class LossOf>
HeadResult Evaluate(const Head& head, const HeadBatch& batch, const LossOf& loss_of) {
  const bool with_gradient = !head.gradient.empty();
  const at::AutoGradMode mode(with_gradient);
  const torch::Tensor features =
      View(batch.features, kFeatureSize).set_requires_grad(with_gradient);
  const HeadParameters parameters(head.layout, head.values, with_gradient);
  const Loss loss = loss_of(parameters, features);
  HeadResult result{loss.losses, loss.objective.template item<double>(), {}};
  if (!with_gradient) return result;
  loss.objective.backward();
  parameters.AddGradient(head.gradient);
  if (features.grad().defined()) result.feature_gradient = ToVector(features.grad());
  return result;
}

}  // namespace

void UseOneTorchThread() {
  at::set_num_threads(1);
  at::init_num_threads();
}

HeadResult ActorObjective(const StageNetworks& networks, const HeadBatch& batch,
                          const TrainConfig& config, std::span<float> gradient) {
  const auto loss_of = [&](const HeadParameters& parameters, const torch::Tensor& features) {
    const Actor actor(networks, parameters, batch, features);
    const torch::Tensor actions = View(batch.actions, 9);
    const torch::Tensor wanted = Denormalise(networks.normalisation.action, actions);
    const auto [mean, log_variance] = actor.Posterior(actions);
    const torch::Tensor latent = mean + (0.5 * log_variance).exp() * View(batch.noise, kLatentSize);
    const torch::Tensor divergence =
        (0.5 * (mean.square() + log_variance.exp() - 1 - log_variance)).sum(1).mean();
    const Reconstruction posterior = Compare(actor.Decode(latent), wanted);
    const Reconstruction prior = Compare(actor.Decode(torch::zeros_like(latent)), wanted);
    const auto weigh = [&](const Reconstruction& r) {
      return config.lambda_position * r.position + config.lambda_rotation * r.rotation;
    };
    Loss loss{weigh(posterior) + config.prior_reconstruction * weigh(prior) +
              config.lambda_kl * divergence};
    loss.losses.position_m = prior.position.item<double>();
    loss.losses.rotation_rad = prior.rotation.item<double>();
    loss.losses.divergence = divergence.item<double>();
    return loss;
  };
  return Evaluate({networks.actor_layout(), networks.actor, gradient}, batch, loss_of);
}

HeadResult CriticObjective(const StageNetworks& networks, const HeadBatch& batch,
                           std::span<float> gradient) {
  return Evaluate({networks.critic_layout(), networks.critic, gradient}, batch,
                  [&](const HeadParameters& parameters, const torch::Tensor& features) {
                    return MeanAbsolute(CriticScore(parameters, networks, batch, features), batch,
                                        &StageLosses::angle_gain_rad);
                  });
}

HeadResult DiscriminatorObjective(const StageNetworks& networks, const HeadBatch& batch,
                                  const TrainConfig& config, std::span<float> gradient) {
  const auto loss_of = [&](const HeadParameters& parameters, const torch::Tensor& features) {
    const torch::Tensor score = DiscriminatorScore(parameters, networks, batch, features);
    Loss loss = MeanAbsolute(score, batch, &StageLosses::angle_gain_rad);
    if (config.score_loss == ScoreLoss::kSquared)
      loss.objective = (score - View(batch.angle_gains_rad, 1)).square().mean();
    return loss;
  };
  return Evaluate({networks.critic_layout(), networks.critic, gradient}, batch, loss_of);
}

HeadResult AffordanceObjective(const StageNetworks& networks, const HeadBatch& batch,
                               std::span<float> gradient) {
  return Evaluate({networks.actor_layout(), networks.actor, gradient}, batch,
                  [&](const HeadParameters& parameters, const torch::Tensor& features) {
                    return MeanAbsolute(AffordanceScore(parameters, networks, batch, features),
                                        batch, &StageLosses::affordance_rad);
                  });
}

HeadResult FinderObjective(const FinderNetwork& network, const HeadBatch& batch,
                           std::span<float> gradient) {
  return Evaluate(
      {network.layout, network.parameters, gradient}, batch,
      [&](const HeadParameters& parameters, const torch::Tensor& features) {
        const torch::Tensor hidden = parameters.Dense("score.0", features);
        const torch::Tensor logit =
            parameters.Dense("score.1", torch::leaky_relu(hidden, kLeakySlope));
        const torch::Tensor weight = View(batch.weights, 1);
        Loss loss{(weight * torch::binary_cross_entropy_with_logits(logit, View(batch.is_handle, 1),
                                                                    {}, {}, at::Reduction::None))
                      .sum() /
                  weight.sum()};
        loss.losses.*network.reported = loss.objective.item<double>();
        return loss;
      });
}

}  // namespace doorforge::internal

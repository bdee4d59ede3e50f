// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/learn/train_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/learn/point_encoder.h"

#include "adam.h"
#include "head_networks.h"
#include "network_batch.h"
#include "sampler.h"

namespace doorforge {
namespace {

using internal::EncodedBatch;
using internal::GeometryCache;
using internal::HeadBatch;
using internal::HeadResult;

using Geometries = std::vector<std::shared_ptr<const CloudGeometry>>;

// A batch's gradient is the sum of this many parts, each summed over its samples in order, so that
// it does not depend on the number of threads.
constexpr std::size_t kGradientParts = 8;

std::size_t BatchSize(std::size_t samples, const TrainConfig& config) {
  return std::min(samples, static_cast<std::size_t>(config.batch_size));
}

double LearningRate(const TrainConfig& config, std::uint64_t step, std::uint64_t total) {
  const double warmup = config.warmup_steps > 0
                            ? std::min(1.0, static_cast<double>(step + 1) / config.warmup_steps)
                            : 1.0;
  const auto s = static_cast<double>(step);
  double decay = 1;
  if (config.schedule == "cosine")
    decay = 0.01 + 0.99 * 0.5 * (1 + std::cos(std::numbers::pi * s / static_cast<double>(total)));
  if (config.schedule == "step") decay = std::pow(0.9, std::floor(s / 5000));
  return config.learning_rate * warmup * decay;
}

StageLosses Scaled(const StageLosses& losses, double factor) {
  return {losses.position_m * factor, losses.rotation_rad * factor, losses.divergence * factor,
          losses.score_rad * factor};
}

StageLosses Sum(const StageLosses& a, const StageLosses& b) {
  return {a.position_m + b.position_m, a.rotation_rad + b.rotation_rad, a.divergence + b.divergence,
          a.score_rad + b.score_rad};
}

// One of the two networks with what its training needs between steps.
struct Network {
  const ParameterLayout* layout;
  std::vector<float>* parameters;
  std::vector<float>* first;
  std::vector<float>* second;
  EncodedBatch encoded;
  std::array<std::vector<float>, kGradientParts> parts;
  std::vector<float> gradient;
  std::vector<float> feature_gradient;
};

class Trainer {
 public:
  Trainer(std::span<const TrainingSample> train, std::span<const TrainingSample> validation,
          const TrainConfig& config, const TrainHooks& hooks)
      : train_(train),
        validation_(validation),
        config_(config),
        hooks_(hooks),
        threads_(ThreadCount(hooks.threads)),
        instruction_set_(BestInstructionSet()),
        state_(hooks.resume ? *hooks.resume : InitialState()),
        geometry_(train, state_.networks.normalisation.cloud_centre_m, hooks.geometry_cache_bytes),
        validation_geometry_(validation, state_.networks.normalisation.cloud_centre_m,
                             hooks.geometry_cache_bytes / 4) {
    actor_ = {&ActorLayout(),
              &state_.networks.actor,
              &state_.actor_first,
              &state_.actor_second,
              {},
              {},
              {},
              {}};
    critic_ = {&CriticLayout(),
               &state_.networks.critic,
               &state_.critic_first,
               &state_.critic_second,
               {},
               {},
               {},
               {}};
  }

  TrainerState Run() {
    const std::uint64_t per_epoch = StepsPerEpoch(train_.size(), config_);
    const std::uint64_t total = per_epoch * static_cast<std::uint64_t>(config_.epochs);
    while (state_.step < total) {
      const StageLosses losses = Step(per_epoch, total);
      state_.steps.push_back(losses);
      ++state_.step;
      CheckFinite(losses);
      if (state_.step % per_epoch == 0) EndEpoch(per_epoch);
      if (hooks_.on_step) hooks_.on_step(state_);
      if (hooks_.stop && hooks_.stop()) break;
    }
    return std::move(state_);
  }

 private:
  TrainerState InitialState() const {
    TrainerState state;
    state.networks =
        InitialNetworks(MeasureNormalisation(train_), config_.linear_branches, config_.seed);
    state.actor_first.resize(ActorLayout().size());
    state.actor_second.resize(ActorLayout().size());
    state.critic_first.resize(CriticLayout().size());
    state.critic_second.resize(CriticLayout().size());
    return state;
  }

  // The critic is left out on some steps if the config says so.
  bool CriticLearns() const {
    return state_.step % static_cast<std::uint64_t>(config_.critic_interval) == 0;
  }

  PointEncoder EncoderOf(const Network& network) const {
    return {*network.layout, "encoder.", *network.parameters, instruction_set_};
  }

  StageLosses Step(std::uint64_t per_epoch, std::uint64_t total) {
    const std::size_t size = BatchSize(train_.size(), config_);
    const std::vector<std::size_t> indices = internal::BatchOf(
        config_.seed, state_.step / per_epoch, state_.step % per_epoch, train_.size(), size);
    const Geometries geometries = geometry_.Get(indices, threads_);
    HeadBatch batch = internal::MakeHeadBatch(train_, indices, state_.networks.normalisation);
    batch.noise = internal::LatentNoise(config_.seed, state_.step, size * kLatentSize);

    std::vector<Network*> learning = {&actor_};
    if (CriticLearns()) learning.push_back(&critic_);
    const std::vector<PointEncoder> encoders = Encode(learning, geometries);
    StageLosses losses = Heads(learning, batch);
    Backward(learning, encoders, geometries);
    const internal::AdamRates rates{LearningRate(config_, state_.step, total),
                                    config_.weight_decay};
    ParallelFor(learning.size(), threads_, [&](std::size_t n) {
      Network& network = *learning[n];
      for (const std::vector<float>& part : network.parts) {
        for (std::size_t i = 0; i < part.size(); ++i) network.gradient[i] += part[i];
      }
      const std::uint64_t updates =
          &network == &actor_ ? state_.step
                              : state_.step / static_cast<std::uint64_t>(config_.critic_interval);
      AdamStep(rates, updates + 1, network.gradient,
               {*network.parameters, *network.first, *network.second});
    });
    // a step without the critic repeats its last loss in the record
    if (learning.size() == 1) losses.score_rad = state_.steps.back().score_rad;
    return losses;
  }

  std::vector<PointEncoder> Encode(const std::vector<Network*>& networks,
                                   const Geometries& geometries) const {
    std::vector<std::optional<PointEncoder>> packed(networks.size());
    ParallelFor(networks.size(), threads_,
                [&](std::size_t n) { packed[n].emplace(EncoderOf(*networks[n])); });
    std::vector<PointEncoder> encoders;
    encoders.reserve(packed.size());
    for (auto& encoder : packed) encoders.push_back(std::move(*encoder));
    for (Network* network : networks) network->encoded.Resize(geometries.size());
    ParallelFor(networks.size() * geometries.size(), threads_, [&](std::size_t task) {
      const std::size_t n = task / geometries.size();
      const std::size_t i = task % geometries.size();
      networks[n]->encoded.Encode(encoders[n], *geometries[i], i);
    });
    return encoders;
  }

  StageLosses Heads(const std::vector<Network*>& networks, HeadBatch& batch) {
    StageLosses losses;
    for (Network* network : networks) {
      batch.features = network->encoded.Features(static_cast<std::size_t>(batch.size));
      network->gradient.assign(network->layout->size(), 0.0F);
      HeadResult result = RunHead(*network, batch, true);
      network->feature_gradient = std::move(result.feature_gradient);
      losses = Sum(losses, result.losses);
    }
    return losses;
  }

  HeadResult RunHead(Network& network, const HeadBatch& batch, bool with_gradient) const {
    const std::span<float> gradient =
        with_gradient ? std::span<float>(network.gradient) : std::span<float>();
    if (&network == &critic_) return CriticObjective(state_.networks, batch, gradient);
    return ActorObjective(state_.networks, batch, config_, gradient);
  }

  void Backward(const std::vector<Network*>& networks, const std::vector<PointEncoder>& encoders,
                const Geometries& geometries) const {
    ParallelFor(networks.size() * kGradientParts, threads_, [&](std::size_t task) {
      Network& network = *networks[task / kGradientParts];
      const std::size_t p = task % kGradientParts;
      std::vector<float>& part = network.parts[p];
      part.assign(network.layout->size(), 0.0F);
      const std::size_t begin = p * geometries.size() / kGradientParts;
      const std::size_t end = (p + 1) * geometries.size() / kGradientParts;
      for (std::size_t i = begin; i < end; ++i)
        encoders[task / kGradientParts].AddGradient(
            *geometries[i], network.encoded.trace(i),
            std::span(network.feature_gradient).subspan(i * kFeatureSize, kFeatureSize), part);
    });
  }

  void EndEpoch(std::uint64_t per_epoch) {
    EpochLosses epoch;
    for (std::uint64_t i = state_.step - per_epoch; i < state_.step; ++i)
      epoch.train = Sum(epoch.train, Scaled(state_.steps[i], 1.0 / static_cast<double>(per_epoch)));
    epoch.validation = Validate();
    state_.epochs.push_back(epoch);
    if (hooks_.on_epoch) hooks_.on_epoch(state_);
  }

  // Mean over the validation set; NaN if there is none.
  StageLosses Validate() {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (validation_.empty()) return {kNone, kNone, kNone, kNone};
    constexpr std::size_t kChunk = 64;
    StageLosses sum;
    for (std::size_t begin = 0; begin < validation_.size(); begin += kChunk) {
      std::vector<std::size_t> indices(std::min(kChunk, validation_.size() - begin));
      std::iota(indices.begin(), indices.end(), begin);
      const Geometries geometries = validation_geometry_.Get(indices, threads_);
      HeadBatch batch =
          internal::MakeHeadBatch(validation_, indices, state_.networks.normalisation);
      batch.noise.assign(indices.size() * kLatentSize, 0.0F);
      const std::vector<Network*> both = {&actor_, &critic_};
      Encode(both, geometries);
      for (Network* network : both) {
        batch.features = network->encoded.Features(indices.size());
        const HeadResult result = RunHead(*network, batch, false);
        sum = Sum(sum, Scaled(result.losses, static_cast<double>(indices.size())));
      }
    }
    return Scaled(sum, 1.0 / static_cast<double>(validation_.size()));
  }

  void CheckFinite(const StageLosses& losses) const {
    const double sum =
        losses.position_m + losses.rotation_rad + losses.divergence + losses.score_rad;
    Require(std::isfinite(sum), ErrorCode::kIncomplete,
            "training diverged at step " + std::to_string(state_.step) +
                ": a loss is not finite; lower learning_rate");
  }

  std::span<const TrainingSample> train_;
  std::span<const TrainingSample> validation_;
  const TrainConfig& config_;
  const TrainHooks& hooks_;
  int threads_;
  InstructionSet instruction_set_;
  TrainerState state_;
  GeometryCache geometry_;
  GeometryCache validation_geometry_;
  Network actor_{};
  Network critic_{};
};

void RequireConfig(bool condition, const char* key, const char* allowed) {
  if (!condition)
    throw Error(ErrorCode::kInvalidConfig, std::string("config.") + key + ": must be " + allowed);
}

}  // namespace

void CheckTrainConfig(const TrainConfig& config) {
  RequireConfig(config.epochs >= 1, "epochs", "at least 1");
  RequireConfig(config.batch_size >= 1, "batch_size", "at least 1");
  RequireConfig(config.learning_rate > 0, "learning_rate", "positive");
  RequireConfig(config.weight_decay >= 0, "weight_decay", "at least 0");
  RequireConfig(
      config.schedule == "cosine" || config.schedule == "step" || config.schedule == "constant",
      "schedule", "cosine, step or constant");
  RequireConfig(config.warmup_steps >= 0, "warmup_steps", "at least 0");
  RequireConfig(config.lambda_position >= 0 && config.lambda_rotation >= 0 &&
                    config.lambda_kl >= 0 && config.prior_reconstruction >= 0,
                "lambda_*", "at least 0");
  RequireConfig(config.critic_interval >= 1, "critic_interval", "at least 1");
  RequireConfig(config.validation_share >= 0 && config.validation_share < 1, "validation_share",
                "in [0, 1)");
}

std::uint64_t StepsPerEpoch(std::size_t samples, const TrainConfig& config) {
  return samples == 0 ? 0 : samples / BatchSize(samples, config);
}

TrainerState TrainStage(std::span<const TrainingSample> train,
                        std::span<const TrainingSample> validation, const TrainConfig& config,
                        const TrainHooks& hooks) {
  CheckTrainConfig(config);
  Require(!train.empty(), ErrorCode::kInvalidArgument, "no sample to train from");
  internal::UseOneTorchThread();
  return Trainer(train, validation, config, hooks).Run();
}

}  // namespace doorforge

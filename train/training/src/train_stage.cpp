// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/train_stage.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/networks/hand_frame.h"
#include "doorforge/networks/point_encoder.h"

#include "adam.h"
#include "best_networks.h"
#include "device_encoder.h"
#include "head_objectives.h"
#include "network_batch.h"
#include "ordered_calls.h"
#include "sampler.h"
#include "shared_batch.h"
#include "stage_task.h"

namespace doorforge {
namespace {

using internal::BatchFeatures;
using internal::EncodedBatch;
using internal::Geometries;
using internal::HeadResult;
using internal::Minibatch;
using internal::NetworkRole;
using internal::SampleSet;
using internal::StageTask;

// A batch's gradient is the sum of this many parts, each summed over its samples in order, and the
// parts are summed in pairs, pairs of pairs and so on: so it depends neither on the number of
// threads nor on that of processes, each of which has a subtree.
constexpr std::size_t kGradientParts = 8;

constexpr float kHandleScale = 0.1F;  // [m]

// Sums equally long parts, a power of two of them, as a binary tree; the sum is left in the first.
void SumAsTree(std::span<std::span<float>> parts) {
  for (std::size_t stride = 1; stride < parts.size(); stride *= 2) {
    for (std::size_t i = 0; i < parts.size(); i += 2 * stride) {
      const std::span<float> sum = parts[i];
      const std::span<float> addend = parts[i + stride];
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += addend[k];
    }
  }
}

constexpr std::array<std::optional<double> StageLosses::*, 7> kLosses = {
    &StageLosses::position_m,
    &StageLosses::rotation_rad,
    &StageLosses::divergence,
    &StageLosses::angle_gain_rad,
    &StageLosses::affordance_rad,
    &StageLosses::place,
    &StageLosses::mask};

// `losses` with those values of `newer` that are known.
StageLosses Updated(StageLosses losses, const StageLosses& newer) {
  for (const auto value : kLosses) {
    if (newer.*value) losses.*value = newer.*value;
  }
  return losses;
}

StageLosses ZeroLosses() {
  StageLosses zero;
  for (const auto value : kLosses) zero.*value = 0;
  return zero;
}

// A sum of which one addend is not known is not known.
void AddScaled(const StageLosses& losses, double factor, StageLosses& sum) {
  for (const auto value : kLosses) {
    if (!(losses.*value)) sum.*value = std::nullopt;
    if (sum.*value) *(sum.*value) += factor * *(losses.*value);
  }
}

// The extent of clouds from near by: a finder has seen the whole door as well.
float ExtentOf(std::span<const TrainingSample> samples, NetworkFamily family) {
  const auto near = std::ranges::find_if(
      samples, [](const TrainingSample& sample) { return sample.cloud_crop_radius_m > 0; });
  const bool finds = family == NetworkFamily::kFind && near != samples.end();
  return (finds ? *near : samples.front()).cloud_crop_radius_m;
}

// All clouds are made in one way, which the policy's record tells whoever lets it act.
void RequireLikeClouds(std::span<const TrainingSample> samples, NetworkFamily family) {
  const float extent_m = ExtentOf(samples, family);
  for (const TrainingSample& sample : samples) {
    const bool of_whole = family == NetworkFamily::kFind && sample.cloud_crop_radius_m == 0;
    Require(of_whole || sample.cloud_crop_radius_m == extent_m, ErrorCode::kInvalidArgument,
            "the data sets' clouds have different extents (cloud_within_m in meta.json); train "
            "from those with the same");
    Require(sample.remembered_finer == samples.front().remembered_finer,
            ErrorCode::kInvalidArgument,
            "some of the data sets' clouds hold what was seen before the robot came, and others "
            "do not, or not as finely (remembered_finer in meta.json); train from those with the "
            "same, or make them alike with `doorforge dataset re-observe`");
  }
}

NetworkView ViewOf(const TrainConfig& config, std::span<const TrainingSample> samples) {
  NetworkView view;
  view.frame = config.frame;
  if (config.family == NetworkFamily::kMotion) view.state = config.state;
  view.crop_radius_m = static_cast<float>(config.crop_radius_m);
  view.point_scale = static_cast<float>(config.point_scale);
  RequireLikeClouds(samples, config.family);
  view.cloud_crop_radius_m = ExtentOf(samples, config.family);
  view.remembered_finer = samples.front().remembered_finer;
  if (config.family == NetworkFamily::kGrasp) view.near_points = config.near_points;
  view.colors = config.colors;
  return view;
}

std::vector<TrainingSample> AllInHandFrame(std::span<const TrainingSample> samples,
                                           NetworkFamily family) {
  const auto convert =
      family == NetworkFamily::kMotion ? internal::WithTurns : internal::AboutContact;
  std::vector<TrainingSample> converted;
  converted.reserve(samples.size());
  for (const TrainingSample& sample : samples) converted.push_back(convert(sample));
  return converted;
}

// Parameters of a layout that begins with an encoder's layers.
std::size_t EncoderSize(const ParameterLayout& layout) {
  std::size_t end = 0;
  for (const DenseLayer& layer : layout.layers()) {
    if (layer.name.starts_with("encoder.")) end = layer.end();
  }
  return end;
}

// One of the two networks with what its training needs between steps.
struct Network {
  NetworkRole role;
  const ParameterLayout* layout;
  const ParameterLayout* plain;  // of the same network without normalised layers
  std::vector<float>* parameters;
  std::vector<float>* first;
  std::vector<float>* second;
  LayerStatistics* statistics;
  EncodedBatch encoded{};
  std::optional<internal::DeviceEncoder> torch_encoder{};  // in the place of `encoded`
  std::array<std::vector<float>, kGradientParts> parts{};  // of the encoder's gradient
  std::vector<float> gradient{};
  std::vector<float> feature_gradient{};
  std::future<void> sum{};  // of the encoder's gradient over all processes
};

class Trainer {
 public:
  Trainer(std::span<const TrainingSample> train, std::span<const TrainingSample> validation,
          const TrainConfig& config, const TrainHooks& hooks)
      : train_(train),
        validation_(validation),
        config_(config),
        hooks_(hooks),
        alone_(hooks.group == nullptr ? SingleProcessGroup() : nullptr),
        group_(hooks.group == nullptr ? *alone_ : *hooks.group),
        calls_(group_.size() > 1),
        threads_(ThreadCount(hooks.threads)),
        instruction_set_(BestInstructionSet()),
        state_(hooks.resume ? *hooks.resume : InitialState()),
        networks_{Network{NetworkRole::kActor, &state_.networks.actor_layout(),
                          &ActorLayout(config.family, PlainKind()), &state_.networks.actor,
                          &state_.actor_first_moment, &state_.actor_second_moment,
                          &state_.actor_statistics},
                  Network{NetworkRole::kCritic, &state_.networks.critic_layout(),
                          &CriticLayout(config.family, PlainKind()), &state_.networks.critic,
                          &state_.critic_first_moment, &state_.critic_second_moment,
                          &state_.critic_statistics}},
        task_(MakeTask()) {}

  TrainerState Run() {
    const std::uint64_t per_epoch = StepsPerEpoch(train_.size(), config_);
    std::uint64_t end = 0;
    for (int number = 0; number < internal::PhasesOf(config_.family); ++number) {
      const std::uint64_t begin = end;
      end += per_epoch * static_cast<std::uint64_t>(internal::EpochsOfPhase(config_, number));
      if (state_.step >= end) continue;
      task_->Begin(number, PolicyOf(state_));
      if (!RunPhase({number, begin, end, per_epoch})) break;
    }
    RequireSoundSamples();
    return std::move(state_);
  }

 private:
  // Steps [begin, end) of the run.
  struct Phase {
    int number;
    std::uint64_t begin;
    std::uint64_t end;
    std::uint64_t per_epoch;
  };

  // False if the run is to stop.
  bool RunPhase(const Phase& phase) {
    while (state_.step < phase.end) {
      const StageLosses losses = Step(phase);
      state_.steps.push_back(Updated(LastLosses(), losses));
      ++state_.step;
      if (state_.step % phase.per_epoch == 0) EndEpoch(phase.number, phase.per_epoch);
      if (hooks_.on_step) hooks_.on_step(state_);
      if (StopsSomewhere()) return false;
    }
    return true;
  }

  EncoderKind PlainKind() const { return {EncoderNorm::kNone, config_.colors}; }

  TrainerState InitialState() const {
    TrainerState state;
    state.networks = hooks_.initial
                         ? *hooks_.initial
                         : InitialNetworks(MeasuredNormalisation(), config_.linear_branches,
                                           config_.seed, config_.family, config_.encoder_norm);
    state.actor_statistics = InitialStatistics(state.networks.actor_layout());
    state.critic_statistics = InitialStatistics(state.networks.critic_layout());
    state.actor_first_moment.resize(state.networks.actor.size());
    state.actor_second_moment.resize(state.networks.actor.size());
    state.critic_first_moment.resize(state.networks.critic.size());
    state.critic_second_moment.resize(state.networks.critic.size());
    return state;
  }

  StageNormalisation MeasuredNormalisation() const {
    const NetworkView view = ViewOf(config_, train_);
    StageNormalisation normalisation = MeasureNormalisation(AllShown(), view);
    // about the contact its own place is 0 always: the scale is that of the handle's other points
    if (config_.family == NetworkFamily::kGrasp && view.frame == ViewFrame::kHand)
      std::fill_n(normalisation.action.deviation.begin(), 3, kHandleScale);
    if (config_.family == NetworkFamily::kFind) normalisation.angle_gain_rad = {{0.0F}, {1.0F}};
    return normalisation;
  }

  // Motion samples with their mirror images, where these are learned from as well: the mirror image
  // of a normalised number is normalised then.
  std::vector<TrainingSample> AllShown() const {
    std::vector<TrainingSample> all(train_.begin(), train_.end());
    if (config_.family != NetworkFamily::kMotion || !config_.augment_mirror) return all;
    for (const TrainingSample& sample : train_)
      all.push_back(internal::WithoutCloudMirrored(sample));
    return all;
  }

  std::unique_ptr<StageTask> MakeTask() const {
    const internal::TaskInput input{
        train_, validation_, &config_, &state_.networks, hooks_.geometry_cache_bytes, threads_};
    if (config_.family == NetworkFamily::kFind) return internal::MakeFindTask(input);
    return config_.family == NetworkFamily::kGrasp ? internal::MakeGraspTask(input)
                                                   : internal::MakeMotionTask(input);
  }

  // All processes of a group stop after the same step.
  bool StopsSomewhere() {
    if (!hooks_.stop) return false;
    const float stops = hooks_.stop() ? 1.0F : 0.0F;
    const std::vector<float> all = group_.Gather(std::span(&stops, 1));
    return std::any_of(all.begin(), all.end(), [](float one) { return one != 0; });
  }

  // What one process has read from a damaged file is in the sums of all.
  void RequireSoundSamples() {
    if (!hooks_.check_samples) return;
    std::exception_ptr problem;
    try {
      hooks_.check_samples();
    } catch (const Error&) {
      problem = std::current_exception();
    }
    const float damaged = problem ? 1.0F : 0.0F;
    const std::vector<float> all = group_.Gather(std::span(&damaged, 1));
    if (problem) std::rethrow_exception(problem);
    if (std::any_of(all.begin(), all.end(), [](float one) { return one != 0; }))
      throw Error(ErrorCode::kIo,
                  "another process of this training has read a damaged data set and says which; "
                  "the state of the last epoch stays");
  }

  // A step without a network repeats its last loss in the record.
  StageLosses LastLosses() const {
    return state_.steps.empty() ? StageLosses{} : state_.steps.back();
  }

  std::uint64_t Interval(const Network& network) const {
    return static_cast<std::uint64_t>(task_->Interval(network.role));
  }

  // Those of the phase's networks whose turn it is.
  std::vector<Network*> NetworksDueAt(int phase, std::uint64_t phase_step) {
    std::vector<Network*> learning;
    for (Network* network : NetworksOf(phase)) {
      if (phase_step % Interval(*network) == 0) learning.push_back(network);
    }
    return learning;
  }

  std::vector<Network*> NetworksOf(int phase) {
    std::vector<Network*> taught;
    for (const NetworkRole role : task_->NetworksOf(phase))
      taught.push_back(&networks_.at(static_cast<std::size_t>(role)));
    return taught;
  }

  PointEncoder EncoderOf(const Network& network) const {
    if (!Normalises()) return {*network.layout, "encoder.", *network.parameters, instruction_set_};
    return {*network.plain, "encoder.", FoldedOf(network), instruction_set_};
  }

  Minibatch BatchAt(const Phase& phase, std::uint64_t step) const {
    return {SampleSet::kTrain,
            internal::BatchOf(config_.seed, step / phase.per_epoch, step % phase.per_epoch,
                              train_.size(), internal::BatchSize(train_.size(), config_)),
            step};
  }

  // These are of this process's share of the step's batch.
  Geometries GeometriesAt(const Phase& phase, std::uint64_t step) {
    if (next_step_ == step) return std::exchange(next_, {});
    return task_->GeometriesOf(phase.number, OwnShare(BatchAt(phase, step)));
  }

  StageLosses Step(const Phase& phase) {
    const std::uint64_t phase_step = state_.step - phase.begin;
    const std::vector<Network*> learning = NetworksDueAt(phase.number, phase_step);
    for (Network* network : learning) network->gradient.assign(network->layout->size(), 0.0F);
    const StageLosses losses = task_->ReadsClouds(phase.number) ? ThroughClouds(phase, learning)
                                                                : HeadsAlone(phase, learning);
    const internal::AdamRates rates{LearningRateAt(config_, {state_.step, phase.per_epoch}),
                                    config_.weight_decay};
    ParallelFor(learning.size(), threads_, [&](std::size_t n) {
      Network& network = *learning[n];
      RequireFiniteGradient(network);
      AdamStep(rates, phase_step / Interval(network) + 1, network.gradient,
               {*network.parameters, *network.first, *network.second});
    });
    return losses;
  }

  // Leaves the gradients of networks that read no clouds, which every process finds by itself.
  StageLosses HeadsAlone(const Phase& phase, const std::vector<Network*>& learning) {
    StageLosses losses;
    for (Network* network : learning) {
      const HeadResult result =
          task_->Objective(network->role, BatchAt(phase, state_.step), {}, network->gradient);
      RequireFinite(result.objective, "a loss");
      losses = Updated(losses, result.losses);
    }
    return losses;
  }

  // Leaves the gradients of networks that read the clouds, of which each process encodes its share.
  StageLosses ThroughClouds(const Phase& phase, const std::vector<Network*>& learning) {
    const Minibatch batch = BatchAt(phase, state_.step);
    const Geometries geometries = GeometriesAt(phase, state_.step);
    const StageLosses losses = LearnsInTorch() ? StepInTorch(learning, batch, geometries)
                                               : StepInKernels(learning, batch, geometries);
    if (group_.size() > 1 && state_.step + 1 < phase.end) {  // while the sums travel
      next_ = GeometriesAt(phase, state_.step + 1);
      next_step_ = state_.step + 1;
    }
    for (Network* network : learning) {
      network->sum.get();
      AddEncoderGradient(*network);
    }
    return losses;
  }

  // Leaves the encoders' gradients on their way; what one network sends travels while the other
  // computes.
  StageLosses StepInKernels(const std::vector<Network*>& learning, const Minibatch& batch,
                            const Geometries& geometries) {
    const std::vector<PointEncoder> encoders = EncodersOf(learning, geometries);
    std::vector<std::future<BatchFeatures>> features;
    for (std::size_t n = 0; n < learning.size(); ++n)
      features.push_back(
          StartGathering(FeaturesInKernels(*learning[n], At(encoders, n), geometries)));
    StageLosses losses;
    for (std::size_t n = 0; n < learning.size(); ++n) {
      Network& network = *learning[n];
      losses = Updated(losses, Head(network, batch, features[n].get()));
      ClearParts(network);
      if (!geometries.empty())
        BackInKernels(network, encoders[n], geometries, batch.indices.size());
      network.sum = StartSumming(network);
    }
    return losses;
  }

  // Both networks run side by side: libtorch has one thread for each.
  StageLosses StepInTorch(const std::vector<Network*>& learning, const Minibatch& batch,
                          const Geometries& geometries) {
    std::vector<std::vector<float>> own(learning.size());
    ParallelFor(learning.size(), threads_, [&](std::size_t n) {
      internal::UseOneTorchThread();
      Network& network = *learning[n];
      network.torch_encoder.emplace(*network.layout, *network.parameters, OperatorDevice());
      own[n] = network.torch_encoder->Forward(geometries, true);
      MoveTowards(network.torch_encoder->Statistics(), *network.statistics);
    });
    StageLosses losses;
    for (std::size_t n = 0; n < learning.size(); ++n)
      losses = Updated(losses, Head(*learning[n], batch, StartGathering(std::move(own[n])).get()));
    ParallelFor(learning.size(), threads_, [&](std::size_t n) {
      internal::UseOneTorchThread();
      Network& network = *learning[n];
      ClearParts(network);  // the operators sum the whole share as they like
      network.torch_encoder->AddGradient(network.feature_gradient, network.parts[FirstOwnPart()]);
    });
    for (Network* network : learning) network->sum = StartSumming(*network);
    return losses;
  }

  std::size_t OwnParts() const { return kGradientParts / static_cast<std::size_t>(group_.size()); }
  std::size_t FirstOwnPart() const { return OwnParts() * static_cast<std::size_t>(group_.rank()); }

  // The batch's samples that this process encodes.
  Minibatch OwnShare(const Minibatch& batch) const {
    const std::size_t size = batch.indices.size();
    const auto begin = batch.indices.begin();
    const auto cut = [&](std::size_t part) {
      return begin + static_cast<std::ptrdiff_t>(part * size / kGradientParts);
    };
    return {batch.set, {cut(FirstOwnPart()), cut(FirstOwnPart() + OwnParts())}, batch.step};
  }

  bool OnDevice() const { return config_.device != "cpu"; }
  bool Normalises() const { return config_.encoder_norm == EncoderNorm::kBatch; }
  const char* OperatorDevice() const { return OnDevice() ? config_.device.c_str() : "libtorch"; }
  std::vector<float> FoldedOf(const Network& network) const {
    return FoldNorms(*network.layout, *network.parameters, *network.statistics);
  }
  bool LearnsInTorch() const { return OnDevice() || Normalises(); }

  // Their weights are packed for this step.
  std::vector<PointEncoder> EncodersOf(const std::vector<Network*>& networks,
                                       const Geometries& geometries) const {
    if (geometries.empty()) return {};
    std::vector<std::optional<PointEncoder>> packed(networks.size());
    ParallelFor(networks.size(), threads_,
                [&](std::size_t n) { packed[n].emplace(EncoderOf(*networks[n])); });
    std::vector<PointEncoder> encoders;
    encoders.reserve(packed.size());
    for (auto& encoder : packed) encoders.push_back(std::move(*encoder));
    return encoders;
  }

  static const PointEncoder* At(const std::vector<PointEncoder>& encoders, std::size_t n) {
    return encoders.empty() ? nullptr : &encoders[n];
  }

  // The network's features of these clouds; it keeps what the way back needs.
  std::vector<float> FeaturesInKernels(Network& network, const PointEncoder* encoder,
                                       const Geometries& geometries) const {
    if (geometries.empty()) return {};
    network.encoded.Resize(geometries.size());
    ParallelFor(geometries.size(), threads_,
                [&](std::size_t i) { network.encoded.Encode(*encoder, *geometries[i], i); });
    return network.encoded.Features(geometries.size());
  }

  std::future<BatchFeatures> StartGathering(std::vector<float> own) {
    return calls_.Start(
        [this, own = std::move(own)] { return internal::GatherFeatures(group_, own); });
  }

  void RequireFinite(double value, const char* name) const {
    Require(std::isfinite(value), ErrorCode::kIncomplete,
            "training diverged at step " + std::to_string(state_.step + 1) + ": " + name +
                " is not finite; lower learning_rate");
  }

  // Fills the network's gradient behind the encoder, and that of its own share of the features.
  // The head is small: every process does the whole batch's, so that its gradient need not travel.
  StageLosses Head(Network& network, const Minibatch& batch, BatchFeatures features) {
    const HeadResult result =
        task_->Objective(network.role, batch, std::move(features.all), network.gradient);
    RequireFinite(result.objective, "a loss");
    const auto own =
        result.feature_gradient.begin() + static_cast<std::ptrdiff_t>(features.own_begin);
    network.feature_gradient.assign(own, own + static_cast<std::ptrdiff_t>(features.own_size));
    return result.losses;
  }

  void ClearParts(Network& network) const {
    for (std::size_t p = FirstOwnPart(); p < FirstOwnPart() + OwnParts(); ++p)
      network.parts.at(p).assign(EncoderSize(*network.layout), 0.0F);
  }

  // Leaves the encoder's gradient of this process's share in the network's own parts.
  void BackInKernels(Network& network, const PointEncoder& encoder, const Geometries& geometries,
                     std::size_t batch_size) const {
    const std::vector<std::size_t> offsets = FeatureOffsets(geometries);
    const std::size_t first = FirstOwnPart() * batch_size / kGradientParts;
    ParallelFor(OwnParts(), threads_, [&](std::size_t task) {
      const std::size_t p = FirstOwnPart() + task;
      std::vector<float>& part = network.parts[p];
      const std::size_t begin = p * batch_size / kGradientParts - first;
      const std::size_t end = (p + 1) * batch_size / kGradientParts - first;
      for (std::size_t i = begin; i < end; ++i)
        encoder.AddGradient(
            *geometries[i], network.encoded.trace(i),
            std::span(network.feature_gradient).subspan(offsets[i], offsets[i + 1] - offsets[i]),
            part);
    });
  }

  // Leaves the encoder's gradient, of all processes, in the first of the network's own parts.
  std::future<void> StartSumming(Network& network) {
    const auto first = network.parts.begin() + static_cast<std::ptrdiff_t>(FirstOwnPart());
    std::vector<std::span<float>> own(first, first + static_cast<std::ptrdiff_t>(OwnParts()));
    SumAsTree(own);
    return calls_.Start([this, sum = own.front()] { group_.Sum(sum); });
  }

  void AddEncoderGradient(Network& network) const {
    const std::vector<float>& sum = network.parts.at(FirstOwnPart());
    for (std::size_t i = 0; i < sum.size(); ++i) network.gradient[i] += sum[i];
  }

  void RequireFiniteGradient(const Network& network) const {
    std::uint32_t largest = 0;  // magnitude; as bits, which compilers compare many at a time
    for (const float value : network.gradient)
      largest = std::max(largest, std::bit_cast<std::uint32_t>(value) & 0x7fffffffU);
    RequireFinite(static_cast<double>(std::bit_cast<float>(largest)), "a gradient");
  }

  // Where each cloud's features begin among those of the batch.
  static std::vector<std::size_t> FeatureOffsets(const Geometries& geometries) {
    std::vector<std::size_t> offsets = {0};
    for (const auto& geometry : geometries)
      offsets.push_back(offsets.back() + geometry->upsampling[0].size() * kFeatureSize);
    return offsets;
  }

  void EndEpoch(int phase, std::uint64_t per_epoch) {
    EpochLosses epoch{.train = ZeroLosses(), .validation = {}};
    for (std::uint64_t i = state_.step - per_epoch; i < state_.step; ++i)
      AddScaled(state_.steps[i], 1.0 / static_cast<double>(per_epoch), epoch.train);
    const StageLosses before =
        state_.epochs.empty() ? StageLosses{} : state_.epochs.back().validation;
    epoch.validation = Updated(before, Validate(phase));
    RequireSoundSamples();
    state_.epochs.push_back(epoch);
    internal::UpdateBest(config_, state_);
    if (hooks_.on_epoch) hooks_.on_epoch(state_);
  }

  std::vector<float> ValidationFeatures(Network& network, const Geometries& geometries) {
    if (geometries.empty()) return {};
    if (OnDevice())
      return internal::DeviceEncoder(*network.plain, FoldedOf(network), config_.device)
          .Forward(geometries, false);
    const PointEncoder encoder = EncoderOf(network);
    return FeaturesInKernels(network, &encoder, geometries);
  }

  // Mean over the validation set of what the phase teaches.
  StageLosses Validate(int phase) {
    if (validation_.empty()) return StageLosses{};
    constexpr std::size_t kChunk = 64;
    StageLosses sum = ZeroLosses();
    for (std::size_t begin = 0; begin < validation_.size(); begin += kChunk) {
      Minibatch batch{SampleSet::kValidation, {}, 0};
      batch.indices.resize(std::min(kChunk, validation_.size() - begin));
      std::iota(batch.indices.begin(), batch.indices.end(), begin);
      const std::vector<Network*> taught = NetworksOf(phase);
      const bool reads = task_->ReadsClouds(phase);
      const Geometries geometries =
          reads ? task_->GeometriesOf(phase, OwnShare(batch)) : Geometries{};
      StageLosses losses;
      for (Network* network : taught) {
        std::vector<float> features;
        if (reads) features = StartGathering(ValidationFeatures(*network, geometries)).get().all;
        const HeadResult result = task_->Objective(network->role, batch, std::move(features), {});
        RequireFinite(result.objective, "a validation loss");
        losses = Updated(losses, result.losses);
      }
      AddScaled(losses, static_cast<double>(batch.indices.size()), sum);
    }
    StageLosses mean = ZeroLosses();
    AddScaled(sum, 1.0 / static_cast<double>(validation_.size()), mean);
    return mean;
  }

  std::span<const TrainingSample> train_;
  std::span<const TrainingSample> validation_;
  const TrainConfig& config_;
  const TrainHooks& hooks_;
  std::unique_ptr<ProcessGroup> alone_;  // without a group
  ProcessGroup& group_;
  internal::OrderedCalls calls_;  // to the group
  int threads_;
  InstructionSet instruction_set_;
  TrainerState state_;
  std::array<Network, 2> networks_;  // by NetworkRole
  std::unique_ptr<StageTask> task_;
  Geometries next_;  // of `next_step_`, found ahead
  std::optional<std::uint64_t> next_step_;
};

}  // namespace

StageNetworks PolicyOf(const TrainerState& state) {
  StageNetworks policy = state.networks;
  policy.norm = EncoderNorm::kNone;
  policy.actor =
      FoldNorms(state.networks.actor_layout(), state.networks.actor, state.actor_statistics);
  policy.critic =
      FoldNorms(state.networks.critic_layout(), state.networks.critic, state.critic_statistics);
  return policy;
}

TrainerState TrainStage(std::span<const TrainingSample> train,
                        std::span<const TrainingSample> validation, const TrainConfig& config,
                        const TrainHooks& hooks) {
  CheckTrainConfig(config);
  Require(!train.empty(), ErrorCode::kInvalidArgument, "no sample to train from");
  const NetworkView view = ViewOf(config, train);
  Require(!hooks.initial || hooks.initial->normalisation.view == view, ErrorCode::kInvalidArgument,
          "the networks to begin with were trained with other settings of frame, state, "
          "context_m, zoom, near_points or colors, or from clouds of another extent, than \"" +
              std::string(NameOf(config.frame)) + "\", \"" + std::string(NameOf(config.state)) +
              "\", " + std::to_string(config.crop_radius_m));
  if (config.encoder_norm == EncoderNorm::kBatch) {
    Require(
        !hooks.initial, ErrorCode::kInvalidArgument,
        "a policy's batch statistics are folded into its weights, so that training cannot begin "
        "with them; begin without, or with encoder_norm=none");
    Require(
        hooks.group == nullptr || hooks.group->size() == 1, ErrorCode::kInvalidArgument,
        "encoder_norm=batch reads statistics of the whole batch, which several processes do not "
        "share; train in one, or with encoder_norm=none");
  }
  internal::UseOneTorchThread();
  if (view.frame == ViewFrame::kWorld) return Trainer(train, validation, config, hooks).Run();
  const auto train_here = AllInHandFrame(train, config.family);
  const auto validation_here = AllInHandFrame(validation, config.family);
  return Trainer(train_here, validation_here, config, hooks).Run();
}

}  // namespace doorforge

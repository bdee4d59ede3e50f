// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/hand_frame.h"

#include "color_augmentation.h"
#include "grasp_augmentation.h"
#include "sampler.h"
#include "stage_task.h"

namespace doorforge::internal {
namespace {

std::array<float, 3> HandOf(const Proprioception& proprioception) {
  const Eigen::Vector3f hand_m = HandPositionOf(proprioception);
  return {hand_m.x(), hand_m.y(), hand_m.z()};
}

// The mirror image in the world's plane y = 0, see MirroredSideways().
const Eigen::Matrix3d kSideways = Eigen::Vector3d(1, -1, 1).asDiagonal();

class MotionTask : public StageTask {
 public:
  explicit MotionTask(const TaskInput& input)
      : input_(input),
        train_(CacheOf(SampleSet::kTrain, input.cache_bytes)),
        validation_(CacheOf(SampleSet::kValidation, input.cache_bytes / 4)) {}

  std::vector<NetworkRole> NetworksOf(int /*phase*/) const override {
    return {NetworkRole::kActor, NetworkRole::kCritic};
  }

  int Interval(NetworkRole role) const override {
    return role == NetworkRole::kCritic ? input_.config->critic_interval : 1;
  }

  void Begin(int /*phase*/, const StageNetworks& /*networks*/) override {}

  bool ReadsClouds(int /*phase*/) const override { return true; }

  Geometries GeometriesOf(int /*phase*/, const Minibatch& batch) override {
    GeometryCache& cache = batch.set == SampleSet::kTrain ? train_ : validation_;
    Geometries found = cache.Get(batch.indices, input_.threads);
    ParallelFor(found.size(), input_.threads, [&](std::size_t i) {
      if (IsMirrored(batch, batch.indices[i])) found[i] = Augmented(found[i], kSideways);
    });
    Recolor(*input_.config, batch, input_.threads, found);
    return found;
  }

  HeadResult Objective(NetworkRole role, const Minibatch& batch, std::vector<float> features,
                       std::span<float> gradient) override {
    const StageNetworks& networks = *input_.networks;
    const bool trains = batch.set == SampleSet::kTrain;
    const std::vector<TrainingSample> shown = Shown(batch);
    HeadBatch head = MakeHeadBatch(shown, networks.normalisation);
    head.features = std::move(features);
    if (role == NetworkRole::kCritic) {
      head.actions = Executed(shown);
      return CriticObjective(networks, head, gradient);
    }
    const std::size_t draws = batch.indices.size() * kLatentSize;
    head.noise = trains ? LatentNoise(input_.config->seed, batch.step, draws)
                        : std::vector<float>(draws, 0.0F);
    return ActorObjective(networks, head, *input_.config, gradient);
  }

 private:
  // A coin of the sample's own decides on each step, whichever part of the batch a process has.
  bool IsMirrored(const Minibatch& batch, std::size_t index) const {
    if (batch.set != SampleSet::kTrain || !input_.config->augment_mirror) return false;
    Rng rng(input_.config->seed,
            "train/mirror/" + std::to_string(batch.step) + "/" + std::to_string(index));
    return rng.Uniform() < 0.5;
  }

  std::vector<TrainingSample> Shown(const Minibatch& batch) const {
    const auto samples = batch.set == SampleSet::kTrain ? input_.train : input_.validation;
    std::vector<TrainingSample> shown;
    shown.reserve(batch.indices.size());
    for (const std::size_t index : batch.indices)
      shown.push_back(IsMirrored(batch, index) ? WithoutCloudMirrored(samples[index])
                                               : samples[index]);
    return shown;
  }

  // What the critic rates is what was done.
  std::vector<float> Executed(const std::vector<TrainingSample>& samples) const {
    std::vector<float> actions;
    for (const TrainingSample& sample : samples) {
      const auto numbers = input_.networks->normalisation.action.Apply(sample.executed);
      actions.insert(actions.end(), numbers.begin(), numbers.end());
    }
    return actions;
  }

  GeometryCache CacheOf(SampleSet set, std::size_t bytes) const {
    const auto samples = set == SampleSet::kTrain ? input_.train : input_.validation;
    const StageNormalisation& normalisation = input_.networks->normalisation;
    return {samples.size(), 1, bytes, [this, set, samples, &normalisation](std::size_t i) {
              std::vector<float> mirrored;
              const std::span<const float> cloud = ShownCloud(samples[i], mirrored);
              return GeometryFor(*input_.config, set, {cloud, samples[i].rgb},
                                 {WindowOf(normalisation, HandOf(samples[i].proprioception)), {0}});
            }};
  }

  TaskInput input_;
  GeometryCache train_;
  GeometryCache validation_;
};

}  // namespace

std::unique_ptr<StageTask> MakeMotionTask(const TaskInput& input) {
  return std::make_unique<MotionTask>(input);
}

}  // namespace doorforge::internal

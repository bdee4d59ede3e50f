// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/networks/training_sample.h"
#include "doorforge/training/train_stage.h"

#include "head_objectives.h"
#include "network_batch.h"

namespace doorforge::internal {

/// The two networks of a stage, see NetworkFamily.
enum class NetworkRole { kActor, kCritic };

enum class SampleSet { kTrain, kValidation };

/// Where of a cloud features are read.
struct EncoderQuery {
  CloudWindow window;
  std::vector<std::uint16_t> points;
};

/// What the encoder needs to know of a cloud: no more than what is read depends on, but all of it
/// where training reads statistics over all rows.
CloudGeometry GeometryFor(const TrainConfig& config, SampleSet set, const CloudView& cloud,
                          const EncoderQuery& reading);

/// Some samples on their way through a network.
struct Minibatch {
  SampleSet set = SampleSet::kTrain;
  std::vector<std::size_t> indices;
  std::uint64_t step =
      0;  ///< It counts the run's steps and names the random draws. Validation draws nothing.
};

/// What a stage teaches its networks, in phases one after the other. The loop of
/// TrainStage() knows steps, gradients and checkpoints, and nothing of what is learnt; a task knows
/// nothing of steps but the number that names a step's draws.
class StageTask {
 public:
  virtual ~StageTask() = default;

  /// Networks that a phase teaches; all read the same geometries.
  virtual std::vector<NetworkRole> NetworksOf(int phase) const = 0;
  /// A network learns on every n-th step of its phase.
  virtual int Interval(NetworkRole role) const = 0;
  /// Called before a phase's first step in this process: once in a run, again when it is resumed.
  virtual void Begin(int phase, const StageNetworks& networks) = 0;
  /// False: the phase's networks need no clouds; features are empty then.
  virtual bool ReadsClouds(int phase) const = 0;
  /// Exists for a phase that reads clouds.
  virtual Geometries GeometriesOf(int phase, const Minibatch& batch) = 0;
  /// Evaluates one network; the gradient is added to `gradient` unless that is empty.
  virtual HeadResult Objective(NetworkRole role, const Minibatch& batch,
                               std::vector<float> features, std::span<float> gradient) = 0;
};

/// Samples of a batch, of so many in all.
std::size_t BatchSize(std::size_t samples, const TrainConfig& config);
/// Phases of a family: 1, or 2 where one network learns from the other's ratings.
int PhasesOf(NetworkFamily family);
/// Passes over the samples of one of them.
int EpochsOfPhase(const TrainConfig& config, int phase);

/// What a task learns from.
struct TaskInput {
  std::span<const TrainingSample> train;
  std::span<const TrainingSample> validation;
  const TrainConfig* config;
  const StageNetworks* networks;  ///< In training; outlives the task.
  std::size_t cache_bytes;
  int threads;
};

/// Actor and critic, side by side.
std::unique_ptr<StageTask> MakeMotionTask(const TaskInput& input);
/// Discriminator, then affordance.
std::unique_ptr<StageTask> MakeGraspTask(const TaskInput& input);
/// The finder's mask, then its place. Throws Error(kInvalidArgument) where there are not looks of
/// both extents.
std::unique_ptr<StageTask> MakeFindTask(const TaskInput& input);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/batch_norm.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/networks/training_sample.h"
#include "doorforge/policy/train_config.h"
#include "doorforge/training/process_group.h"

namespace doorforge {

/// Throws Error(kInvalidConfig) on a value out of range, or a device that is not here, naming it.
void CheckTrainConfig(const TrainConfig& config);

/// Mean losses of a batch or of a set; nothing where the stage has none of that name, or it was not
/// measured yet. Position and rotation are decoded from the latent 0.
struct StageLosses {
  std::optional<double> position_m = {};      ///< Mean absolute error of a component.
  std::optional<double> rotation_rad = {};    ///< Mean geodesic angle.
  std::optional<double> divergence = {};      ///< Posterior against N(0, I).
  std::optional<double> angle_gain_rad = {};  ///< Critic's or discriminator's mean absolute error.
  std::optional<double> affordance_rad = {};  ///< Affordance's, to the mean of the best ratings.
  std::optional<double> place = {};  ///< The finder's, mean cross entropy of a point [nat]: afar,
  std::optional<double> mask = {};   ///< and near by.
};

/// A loss by its name in files, such as "critic.score_rad".
struct LossColumn {
  const char* name;
  std::optional<double> StageLosses::*value;
};
/// The losses that a stage has.
std::vector<LossColumn> LossColumnsOf(NetworkFamily family);

struct EpochLosses {
  StageLosses train;  ///< Mean over the epoch's steps.
  StageLosses validation;
};

/// The networks as they act, each as it was after the epoch in which it erred least on the
/// validation set (the first of equals): the actor by lambda_position * position + lambda_rotation
/// * rotation, the others by their score. They do not read each other, so that the epochs may
/// differ.
struct BestNetworks {
  BestEpochs epochs;
  StageNetworks networks;  ///< A network whose epoch is 0 is empty.
};

/// Everything that a run needs to go on as if it had never stopped.
struct TrainerState {
  std::uint64_t step = 0;  ///< Steps done.
  StageNetworks networks;
  /// Adam's first and second moments, as the networks' flat vectors.
  std::vector<float> actor_first_moment, actor_second_moment, critic_first_moment,
      critic_second_moment;
  /// Running, of the networks' normalised layers.
  LayerStatistics actor_statistics, critic_statistics;
  std::vector<StageLosses> steps;   ///< One a step done.
  std::vector<EpochLosses> epochs;  ///< One an epoch done.
  BestNetworks best;                ///< They are the best of the epochs done.
};

/// The networks as they act, with the present statistics folded in.
StageNetworks PolicyOf(const TrainerState& state);

/// How a run is carried out; none of it changes the result unless it says so.
struct TrainHooks {
  int threads = 0;  ///< 0: all processors.
  /// Those who share the batches, each with the same arguments; null: this process alone.
  ProcessGroup* group = nullptr;
  /// The networks to begin with, normalisation included; nothing: drawn from the seed. Decides the
  /// result. Not with "batch": a policy's statistics are folded into its weights.
  std::optional<StageNetworks> initial;
  /// Goes on from here. Must come from a run of the same config and samples.
  std::optional<TrainerState> resume;
  /// Called after every step.
  std::function<void(const TrainerState&)> on_step;
  /// Called after every epoch, with its losses measured.
  std::function<void(const TrainerState&)> on_epoch;
  /// Asked at the end of every epoch, before on_epoch, and at the end of the run: throws if what
  /// the samples point to was damaged since they were read. Then no process of a group goes on.
  std::function<void()> check_samples;
  /// Asked after every step; true ends the run there, in all processes of a group.
  std::function<bool()> stop;
  /// Point geometry of the samples is kept up to this size instead of being found again each epoch.
  std::size_t geometry_cache_bytes = std::size_t{2} << 30U;
};

/// Steps of one epoch: whole batches; a set smaller than a batch is one batch.
std::uint64_t StepsPerEpoch(std::size_t samples, const TrainConfig& config);
/// Epochs of the whole run: the grasp's two networks learn one after the other.
int EpochsOf(const TrainConfig& config);

/// A step of a run, counted from 0.
struct TrainingPlace {
  std::uint64_t step = 0;
  std::uint64_t steps_per_epoch = 1;
};
/// The rate at which the networks learn there; the two of the grasp each have a schedule of their
/// own. 0 behind the last step.
double LearningRateAt(const TrainConfig& config, TrainingPlace place);

/// Trains a stage's networks (UniDoorManip, Section 4; departures and their reasons are
/// in docs/design/learn.md): Adam, the losses above, batches that are a pure function of (seed,
/// epoch, step). Gradients are summed over fixed parts of the batch in a fixed order. Actor and
/// critic learn side by side; the discriminator learns before the affordance, whose targets are its
/// ratings; the finder's mask learns before its place, each from the looks of its own extent.
///
/// @returns The state at the end, or where `stop` ended it.
/// @throws Error(kInvalidConfig), also if there is no such device, Error(kInvalidArgument) without
/// samples or with a damaged cloud,
///     Error(kIncomplete) if a loss stops being finite, what `check_samples` throws, and Error(kIo)
///     where it throws in another process of the group.
TrainerState TrainStage(std::span<const TrainingSample> train,
                        std::span<const TrainingSample> validation, const TrainConfig& config,
                        const TrainHooks& hooks);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/learn/train_stage.h"
#include "doorforge/schemas/seen_parts.h"

namespace doorforge {

inline constexpr int kPolicySchemaVersion = 1;

/// What a policy was made from.
struct PolicyProvenance {
  std::string stage;           ///< "open", "handle" or "grasp".
  std::string dataset_sha256;  ///< StageDataset::content_sha256 of what it was trained from.
  std::string code_version;
  TrainConfig config;
  std::uint64_t step = 0;
  std::string from_weights_sha256 = {};  ///< Of the policy that it began with; empty: of none.
  SeenParts trained_on = {};             ///< Empty in records of earlier builds.
  BestEpochs best = {};                  ///< Of which the networks are; all 0: of the last.
};

/// The record of a policy's folder, docs/format-policy.md.
struct PolicyRecord {
  PolicyProvenance provenance;
  std::string weights_sha256;  ///< Of policy.safetensors.
  StageNetworks networks;
};

/// SHA-256 of the effective config's JSON text.
std::string ConfigHash(const TrainConfig& config);

/// Writes `policy.safetensors` (every weight in half precision under its layer's name, after the
/// network's, see NetworkNames) and then `policy.json` (schema doorforge.policy: sizes,
/// normalisation, provenance and the weights' SHA-256). Equal arguments give equal bytes.
void WritePolicy(const std::filesystem::path& folder, const StageNetworks& networks,
                 const PolicyProvenance& provenance);

/// Throws Error(kMissing), Error(kFormat) on a damaged record, one of another stage, or weights
/// that do not belong to it.
PolicyRecord ReadPolicy(const std::filesystem::path& folder, std::string_view stage = "open");

/// Writes `training.safetensors`, one file with all that TrainerState holds, so that a crash leaves
/// either the old state or the new one.
void WriteTrainerState(const std::filesystem::path& folder, const TrainerState& state,
                       const PolicyProvenance& provenance);

/// Whether the folder holds a state to resume from.
bool HasTrainerState(const std::filesystem::path& folder);

/// Reads it back, exactly. Throws Error(kInvalidArgument) if it was written for another config or
/// data set, naming what differs; Error(kFormat) if it is damaged.
TrainerState ReadTrainerState(const std::filesystem::path& folder,
                              const PolicyProvenance& expected);

/// A loss over the epochs; `validation` may hold NaN (null in the file).
struct TrainingCurve {
  std::string name;  ///< As LossColumn.
  std::vector<double> epoch;
  std::vector<double> train;
  std::vector<double> validation;
};

/// When a training's steps come.
struct TrainingPace {
  TrainConfig config;
  std::uint64_t steps_per_epoch = 1;
};

/// Writes `losses.jsonl` (a line a step: step, epoch and learning rate, then the losses),
/// `losses.json` (schema doorforge.losses: the curves) and `events.out.tfevents.doorforge` (both,
/// for TensorBoard).
void WriteLosses(const std::filesystem::path& folder, const TrainerState& state,
                 const TrainingPace& pace);

/// The losses over the epochs done, one curve a loss.
std::vector<TrainingCurve> CurvesOf(const TrainerState& state);

/// Reads `losses.json`. Throws Error(kMissing or kFormat).
std::vector<TrainingCurve> ReadTrainingCurves(const std::filesystem::path& folder);

}  // namespace doorforge

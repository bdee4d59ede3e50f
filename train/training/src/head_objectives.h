// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "doorforge/networks/head_inputs.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/training/train_stage.h"

// The parts of actor and critic behind the encoder as training needs them, in libtorch: losses and
// gradients. Policies run the same layers without it (doorforge/networks/heads.h). Only
// head_objectives.cpp sees libtorch's headers.

namespace doorforge::internal {

/// What both networks of n samples read, and what they learn from.
struct HeadBatch : HeadInputs {
  std::vector<float> angle_gains_rad;  ///< n, [rad].
  std::vector<float> noise;            ///< n x 128, N(0, 1): the actor's latent draws.
  /// n each, of the family kFind: 1 for a handle's point, else 0, and what the point counts.
  std::vector<float> is_handle, weights;
};

struct HeadResult {
  StageLosses losses;                   ///< The network's own.
  double objective = 0;                 ///< What is minimised.
  std::vector<float> feature_gradient;  ///< n x 128; empty if no gradient was asked for.
};

/// Uses one thread for libtorch in this process, whatever the machine has. Idempotent.
void UseOneTorchThread();

/// Objective of the actor (UniDoorManip, Section 4; weights of `config`), its gradient added to
/// `gradient` (a flat vector of ActorLayout(); may be empty: no gradient).
HeadResult ActorObjective(const StageNetworks& networks, const HeadBatch& batch,
                          const TrainConfig& config, std::span<float> gradient);

/// Objective of the critic (5.3, "more" variant), likewise.
HeadResult CriticObjective(const StageNetworks& networks, const HeadBatch& batch,
                           std::span<float> gradient);

/// Objective of the grasp's discriminator (5.4): contact point and rotation are `actions`, and
/// `angle_gains_rad` the door's final angle.
HeadResult DiscriminatorObjective(const StageNetworks& networks, const HeadBatch& batch,
                                  const TrainConfig& config, std::span<float> gradient);

/// Objective of the affordance (5.4): L1 of the score of `points` to `angle_gains_rad`.
HeadResult AffordanceObjective(const StageNetworks& networks, const HeadBatch& batch,
                               std::span<float> gradient);

/// Objective of one of the finder's networks: cross entropy of `is_handle`, weighted.
struct FinderNetwork {
  const ParameterLayout& layout;
  const std::vector<float>& parameters;
  std::optional<double> StageLosses::*reported;
};
HeadResult FinderObjective(const FinderNetwork& network, const HeadBatch& batch,
                           std::span<float> gradient);

}  // namespace doorforge::internal

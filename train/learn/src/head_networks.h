// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/learn/stage_networks.h"
#include "doorforge/learn/train_stage.h"

// The parts of actor and critic behind the encoder, in libtorch. Only head_networks.cpp sees
// libtorch's headers.

namespace doorforge::internal {

/// Inputs of both networks for n samples, row by row. The networks' numbers are normalised.
struct HeadBatch {
  int size = 0;
  std::vector<float> features;  ///< n x 128, of the network at hand.
  std::vector<float> states;    ///< n x 18, normalised.
  std::vector<float> actions;   ///< n x 9, normalised.
  std::vector<float> hands;     ///< n x 3, normalised.
  std::vector<float> bases;     ///< n x 3, normalised.
  /// n x k x 3, as AppendInHandFrame(): the discriminator's, which then reads no features and no
  /// actions; empty: those.
  std::vector<float> near;
  std::vector<float> points;  ///< n x 3, normalised as an action's position: the affordance's.
  std::vector<float> gains;   ///< n, [rad].
  std::vector<float> noise;   ///< n x 128, N(0, 1): the actor's latent draws.
};

struct HeadResult {
  StageLosses losses = UnknownLosses();  ///< The network's own; the rest NaN.
  double objective = 0;                  ///< What is minimised.
  std::vector<float> feature_gradient;   ///< n x 128; empty if no gradient was asked for.
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
/// `gains` the door's final angle.
HeadResult DiscriminatorObjective(const StageNetworks& networks, const HeadBatch& batch,
                                  const TrainConfig& config, std::span<float> gradient);

/// Objective of the affordance (5.4): L1 of the score of `points` to `gains`.
HeadResult AffordanceObjective(const StageNetworks& networks, const HeadBatch& batch,
                               std::span<float> gradient);

/// Action numbers (n x 9, in the world's units) for the batch's features and states and `latents`
/// (n x 128).
std::vector<float> DecodeActions(const StageNetworks& networks, const HeadBatch& batch,
                                 const std::vector<float>& latents);

/// The critic's scores [rad], n.
std::vector<float> ScoreActions(const StageNetworks& networks, const HeadBatch& batch);

/// The discriminator's scores of `actions` [rad], n.
std::vector<float> ScoreGrasps(const StageNetworks& networks, const HeadBatch& batch);

/// The affordance's scores of `points` [rad], n.
std::vector<float> ScorePoints(const StageNetworks& networks, const HeadBatch& batch);

}  // namespace doorforge::internal

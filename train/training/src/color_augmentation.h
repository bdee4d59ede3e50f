// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/core/rng.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/training/train_stage.h"

#include "stage_task.h"

namespace doorforge::internal {

/// The cloud in colours that never were: all hues turned by one angle, contrast scaled by one
/// factor in [0, 1), and brightness moved by one amount. Places stay. What a network learns then
/// cannot hang on the colours by which an episode could be recognised.
std::shared_ptr<const CloudGeometry> Recolored(const std::shared_ptr<const CloudGeometry>& geometry,
                                               Rng& rng);

/// Recolours the clouds of a batch that is learned from, each by a draw of its own that depends on
/// step and sample, not on which part of the batch a process has; nothing where the config does
/// not ask for it.
void Recolor(const TrainConfig& config, const Minibatch& batch, int threads,
             Geometries& geometries);

}  // namespace doorforge::internal

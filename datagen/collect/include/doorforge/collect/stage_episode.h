// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/collect/stage_config.h"
#include "doorforge/collect/stage_policies.h"
#include "doorforge/dataset/collect.h"
#include "doorforge/dataset/collection_plan.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_identity.h"
#include "doorforge/schemas/episode_film.h"

namespace doorforge {

/// Samples the scene of a planned episode, runs its three stages, records one of them, and
/// describes what happened. Thread-safe; a pure function of its arguments.
CollectedEpisode RunStageEpisode(const PlannedEpisode& planned, const IdentifiedDoor& door,
                                 const RobotModel& robot, const StageConfig& config,
                                 StagePolicies& policies);

/// Runs the same episode and returns its course instead of its decisions.
EpisodeFilm FilmStageEpisode(const PlannedEpisode& planned, const IdentifiedDoor& door,
                             const RobotModel& robot, const StageConfig& config,
                             StagePolicies& policies);

}  // namespace doorforge

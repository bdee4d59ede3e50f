// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/rollout/run_episode.h"

#include "episode/contact_log.h"
#include "episode/episode_world.h"

namespace doorforge::internal {

/// Moves the arm to a grasp and closes the fingers. A grasp that somebody chose is tried as it is:
/// the fingers close also where the hand did not quite arrive, and one pad on the handle is enough
/// to go on; see GraspCommand::both_pads.
///
/// @param grasp Its plan says how the arm gets there.
std::optional<Verdict> TakeHold(EpisodeWorld& world, ContactLog& log, const GraspCommand& grasp);

/// The plan of a grasp that came without one.
GraspPlan PlanOf(const GraspCommand& grasp, const EpisodeWorld& world);

}  // namespace doorforge::internal

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/evaluate/run_trials.h"
#include "doorforge/report/report_page.h"
#include "doorforge/schemas/episode_film.h"

namespace doorforge {

/// Trials that have been run, with their rows.
struct FinishedTrials {
  const TrialPlan& trials;
  std::span<const EvaluatedEpisode> rows;  ///< One a trial, in order.
};

/// Doors that get a picture; of more doors, this many are chosen evenly.
inline constexpr std::size_t kMostDoorPictures = 30;

/// Pictures for a report's page: every door closed, a film strip of the first episode of each
/// outcome, and what the camera saw when the policy first decided in an episode that opened the
/// door (else in the first that came so far); and TakeGraspPictures().
///
/// The episodes for film strips are run again with an observer; being deterministic they end in the
/// same state, and one that does not throws Error(kInvalidArgument), because then `policies` is
/// not the one that made the rows; of policies that are Fallible it gets no film strip instead.
/// Same arguments, same pictures, for any number of threads.
ReportPictures TakePictures(const FinishedTrials& finished, const TrialPolicies& policies,
                            int threads = 0);

/// The films of the trials that did not open their door, run again as for pictures; of policies
/// that are Fallible without those that went otherwise. Same arguments, same films, for any number
/// of threads.
std::vector<EpisodeFilm> TakeFilms(const FinishedTrials& finished, const TrialPolicies& policies,
                                   int threads = 0);

/// Heat maps of a grasp policy that Explains() (none of others), by category: on the first
/// door that was opened, then on the first that was not, of those with a handle in view.
std::vector<ReportGrasp> TakeGraspPictures(const FinishedTrials& finished,
                                           const TrialPolicies& policies, int threads = 0);

}  // namespace doorforge

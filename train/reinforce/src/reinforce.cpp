// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/reinforce.h"

#include "doorforge/core/error.h"
#include "doorforge/reinforce/train_distil.h"
#include "doorforge/reinforce/train_trajectories.h"

namespace doorforge {
namespace {

ReinforceOutcome ByTrying(const ReinforceRequest& request, const ConfigSources& sources) {
  Require(!request.rounds, ErrorCode::kInvalidArgument,
          "--rounds: goes with --teacher or --trajectories");
  const PpoTrainingRequest ppo{request, LoadConfig<HandTrainingConfig>(sources), request.features,
                               request.decisions};
  const PpoTrainingOutcome outcome = TrainPpoIntoFolder(ppo);
  return {OutcomeText(outcome, ppo), outcome.finished()};
}

ReinforceOutcome FromTeacher(const ReinforceRequest& request, const ConfigSources& sources) {
  const DistilRequest distil{request, request.teacher, LoadConfig<DistilConfig>(sources),
                             request.rounds};
  const DistilOutcome outcome = DistilIntoFolder(distil);
  return {OutcomeText(outcome, distil), outcome.finished()};
}

ReinforceOutcome OfTrajectories(const ReinforceRequest& request, const ConfigSources& sources) {
  const TrajectoryTrainingRequest training{request, LoadConfig<TrajectoryTrainingConfig>(sources),
                                           request.rounds};
  const TrajectoryTrainingOutcome outcome = TrainTrajectoriesIntoFolder(training);
  return {OutcomeText(outcome, training), outcome.finished()};
}

}  // namespace

ReinforceOutcome Reinforce(const ReinforceRequest& request, const ConfigSources& sources) {
  Require(request.teacher.empty() || !request.trajectories, ErrorCode::kInvalidArgument,
          "--teacher: rules teach trajectories; leave it or --trajectories out");
  if (request.teacher.empty() && !request.trajectories) return ByTrying(request, sources);
  Require(request.features.empty(), ErrorCode::kInvalidArgument,
          "--features: goes with neither --teacher nor --trajectories");
  Require(!request.decisions, ErrorCode::kInvalidArgument,
          "--decisions: with --teacher or --trajectories give --rounds");
  return request.trajectories ? OfTrajectories(request, sources) : FromTeacher(request, sources);
}

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/snapshot_grasp_policy.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Runs one episode: the privileged rules grasp the handle and turn it until it is "handle done"
/// (a door without a latch needs no turn); then `opening` decides every steps_per_action steps, at
/// most max_opening_actions times. These decisions are recorded.
///
/// kOpened means that the hinge passed 45 degrees while a finger's pad touched the handle within
/// the last action; a door that coasts on by itself, or that the arm has pushed on, is not opened.
/// The episode ends after the action in which the hinge passes finish_hinge_rad. `detail` has the
/// numbers: angles, grasp slip, what was touched, distance of finger and handle.
///
/// @param scene Its door_id must be `door`'s.
/// @param observer May be null: policies then see an empty cloud.
/// @throws Error(kInvalidArgument) as DoorWorld does, or if scene and door do not belong together.
///
/// Deterministic as DoorWorld is, if `opening` and `observer` are.
Episode RunEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                   Policy& opening, Observer* observer);

/// Whether the handle is turned, for who cannot look into the simulator; nothing: it is not said.
using HandleTurned = std::function<std::optional<bool>()>;
/// Whether the policies give the present grasp up, because what they ask for leads nowhere. Asked
/// after every action.
using GivesUp = std::function<bool()>;

/// Who acts at each stage, and whose decisions the episode holds.
struct EpisodePolicies {
  Stage recorded = Stage::kOpen;
  SnapshotGraspPolicy* grasp = nullptr;  ///< Null: ExpertGrasp.
  Policy* handle = nullptr;              ///< Null: ExpertUnlock, which turns it in one go.
  /// Asked after each action of `handle`, and not before the first: whether the handle is turned.
  /// Opening begins after the first yes, whatever the simulator knows, also of doors without a
  /// latch. Null: the simulator's flag, turned to "handle done" and unlocked, which doors without
  /// a latch are from the start; so it is after an action of which nothing is said.
  HandleTurned handle_turned = nullptr;
  /// Null: nobody does. The opening of a grasp that is given up ends as one whose hand has let go;
  /// the last grasp is never given up.
  GivesUp gives_up = nullptr;
  Policy* open = nullptr;  ///< Never null.
  /// Drives the first `learner_decisions` of the recorded stage in the place of that stage's
  /// policy, which is asked at each of them what it would do: the record's action corrects the
  /// learner on the states that it gets itself into (Ross et al. 2011). Null: nobody.
  Policy* learner = nullptr;
  int learner_decisions = 0;
  /// So many times the hand may take hold, at least once. Where a grasp led nowhere and the door is
  /// still as good as shut (3 degrees), the fingers open, the hand moves straight back, and `grasp`
  /// is asked again.
  int grasps = 1;
  /// False: a chosen grasp is noted where grasps are recorded, and not tried; the episode ends
  /// there as one without a grasp in view.
  bool tries = true;
};

/// Runs one episode of the three stages: grasp, turn of the handle until it is "handle done" and
/// unlocked (at most max_handle_actions decisions), opening as in RunEpisode(). The physics' action
/// noise is added to the actions of the recorded stage alone, and not to a learner's: those of
/// later stages show what comes of it. `observer` is asked for clouds at recorded decisions and by
/// policies that look.
///
/// Outcomes are RunEpisode()'s. If a predicted flag came before the handle was "handle done", and
/// it never was later, a door that stays locked is kHandleStuck, and `handle_turned` is false. If
/// it does not come within max_handle_actions and the hand still holds, opening is tried all the
/// same: whoever is not told cannot know whether there is a latch, but by trying. A chosen grasp is
/// tried as it is: the fingers close also where the hand did not quite arrive, and one pad on the
/// handle is enough to go on. Without a grasp in view the episode is kNotReached, without
/// decisions.
///
/// @throws Error(kInvalidArgument) as RunEpisode(), or if the recorded stage has nobody to decide.
Episode RunStages(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const EpisodePolicies& roles, Observer* observer);

}  // namespace doorforge

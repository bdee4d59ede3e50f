// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/evaluate/evaluation_config.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/report/evaluated_episode.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/door_identity.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/policy_set.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// The episodes of an evaluation: every door in every seed, by door, seed and episode. A door and
/// its scene are made when they are asked for, so memory does not grow with their number. Safe to
/// use from several threads.
class TrialPlan {
 public:
  /// Plans the trials of the doors 0 to `door_count` - 1. Throws Error(kInvalidConfig) on a number
  /// out of range.
  TrialPlan(DoorGiver give_door, std::size_t door_count, const EvaluationConfig& config);

  std::size_t size() const;  ///< Number of episodes.
  std::size_t door_count() const { return door_count_; }
  std::size_t DoorOf(std::size_t trial) const;  ///< The door's number.

  struct Staged {
    std::shared_ptr<const DoorAsset> door;  ///< Null: it was planned with, and can be read no more.
    Scene scene;                            ///< Without a door only its seed and episode.
    std::string gone = {};                  ///< Why there is no door.
  };
  /// Returns the same in every call for as long as the door is there. Throws as SampleScene().
  Staged At(std::size_t trial) const;

  /// Null if it can be read no more.
  std::shared_ptr<const DoorAsset> Door(std::size_t door) const;
  const RobotModel& robot() const { return robot_; }
  const CloudConfig& cloud() const { return cloud_; }

 private:
  struct Taken {
    IdentifiedDoor door;
    std::string gone;
  };
  Taken Take(std::size_t door) const;

  DoorGiver give_door_;
  std::size_t door_count_;
  std::size_t seeds_;
  std::size_t episodes_per_door_;
  std::uint64_t first_seed_;
  SceneConfig scene_;
  CloudConfig cloud_;
  RobotModel robot_;
};

/// Who is tried: makes sets of policies, and the cameras that they look through.
struct TrialPolicies {
  /// A new set, equal to all others; called from one thread at a time.
  std::function<PolicySet()> make;
  /// The camera of an episode with one of the sets; nothing for policies that need no cloud. May be
  /// called from several threads at once.
  std::function<std::unique_ptr<Observer>(const Scene&, const DoorAsset&, const PolicySet&)>
      make_observer = nullptr;
};

/// How episodes are carried out; but for those of doors that are gone, none of it changes the rows.
struct RunHooks {
  int threads = 0;                                    ///< 0: all processors.
  std::function<void(const EvaluatedEpisode&)> done;  ///< After each; called from any thread.
  /// Who the doors are, by their number: of one that can be read no more the row says so, and its
  /// cause is kDoorGone. Empty: such a door ends the run by Error(kMissing).
  std::span<const DoorIdentity> doors = {};
};

/// Runs the trials and gives their rows in their order.
///
/// Each set serves one episode at a time (RunStages() resets its policies) and may serve several
/// one after the other. The rows do not depend on the number of threads if a policy forgets
/// everything at Reset(). Throws Error(kIncomplete) if the program was asked to stop.
std::vector<EvaluatedEpisode> RunTrials(const TrialPlan& trials, const TrialPolicies& policies,
                                        const RunHooks& hooks = {});

}  // namespace doorforge

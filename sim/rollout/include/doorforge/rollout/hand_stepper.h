// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/hand_policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// When an episode that a hand plays is over.
enum class HandEpisodeEnd {
  /// It is judged as episodes of other policies are: open beyond PhysicsConfig::finish_hinge_rad,
  /// opened without
  /// the grip that EpisodeLimits ask for, or the budget used up.
  kJudged,
  kBudget,  ///< Only with the budget, or where the physics became impossible.
};

/// Where an episode stands.
struct HandInstant {
  HandState state;
  std::array<bool, 2> pads{};  ///< Left and right pad touch the handle.
  bool opened = false;         ///< Success so far, by the scene's EpisodeLimits.
  bool over = false;
  bool diverged = false;  ///< It is over since the physics became impossible.
};

/// Episodes of one door in which one who leads a flying hand and its fingers does everything, from
/// before the handle on. Same world, controller and judge as EpisodeStepper; nobody else acts.
///
/// The hand begins task.start_distance_m before the scene's nominal grasp, along its approach,
/// moved and turned by numbers of the stream "hand_start/<door id>/<episode>" of the scene's seed.
/// Deterministic: the same scene and commands give the same bits. Serves one thread.
class HandStepper {
 public:
  /// @param door, robot Must outlive this.
  /// @throws Error(kInvalidConfig) as CheckHandTask(), and on a robot that does not fly.
  HandStepper(const DoorAsset& door, const RobotModel& robot, const HandTaskConfig& task,
              HandEpisodeEnd end = HandEpisodeEnd::kJudged);
  ~HandStepper();
  HandStepper(HandStepper&&) noexcept;
  HandStepper& operator=(HandStepper&&) noexcept;

  /// Begins an episode.
  ///
  /// @param observer Watches, and is asked for a cloud by Look() alone. May be null.
  /// @throws Error(kInvalidArgument) if the scene is of another door, or its hand cannot get to
  ///     where it is to begin; as DoorWorld and CheckEpisodeLimits().
  const HandInstant& Reset(const Scene& scene, Observer* observer = nullptr);

  /// @throws Error(kInvalidArgument) before Reset(), after the end, and for numbers that are not
  ///     finite.
  const HandInstant& Step(const HandCommand& command);

  /// What the observer sees now; empty without one. Each call is another look, with noise of its
  /// own where the camera has some.
  LabelledCloud Look();

  const HandInstant& now() const;
  /// The record so far, without decisions. Before the end its outcome is that of an end now.
  Episode Summary() const;

 private:
  class Running;
  Running& Live() const;

  const DoorAsset* door_;
  const RobotModel* robot_;
  HandTaskConfig task_;
  HandEpisodeEnd end_;
  std::unique_ptr<Running> running_;
};

/// Runs an episode with a policy that does all of it. The record has no decisions.
///
/// @param observer Gives the clouds of a policy that looks, see CameraObserver::SampleAs().
///
/// @throws as HandStepper.
Episode RunHandEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                       HandPolicy& policy, Observer* observer);

}  // namespace doorforge

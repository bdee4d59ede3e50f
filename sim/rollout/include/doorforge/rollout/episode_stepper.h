// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/handle_rule.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// What becomes of an action that is no motion: numbers that are not finite, or a matrix that is no
/// rotation.
enum class BadAction {
  kRefuse,   ///< Step() throws Error(kInvalidArgument) that says what is wrong with it.
  kDiverge,  ///< It is carried out as far as it goes: the episode ends as kDiverged.
};

/// Who does what that the caller's steps do not.
struct StepperOptions {
  /// The first stage that is the caller's; those before it are run within Reset().
  Stage first = Stage::kOpen;
  /// At the stages before, in the place of the rules ExpertGrasp and ExpertUnlock.
  SnapshotGraspPolicy* grasp = nullptr;
  /// Turns the handle in one go, wherever the stage comes: within Reset() or within Step().
  HandleRule* turn = nullptr;
  Policy* handle = nullptr;  ///< It turns the handle action by action where no such rule is given.
  Policy* open = nullptr;    ///< Runs the opening within Step(); null: it is the caller's.
  /// Means what EpisodePolicies::handle_turned does, and is asked after each action at the stage
  /// "handle".
  HandleTurned handle_turned = nullptr;
  GivesUp gives_up = nullptr;  ///< As EpisodePolicies::gives_up.
  /// Means what EpisodePolicies::grasps does. After a grasp that led nowhere the next stage is
  /// "grasp" again; above 1 where that stage is the caller's.
  int grasps = 1;
  /// Stages whose observations have a cloud; at all others no picture is made.
  std::vector<Stage> clouds = {};
  BadAction bad_action = BadAction::kRefuse;
};

/// Where an episode stands.
struct StepResult {
  Stage stage = Stage::kGrasp;  ///< The next action belongs to it.
  Observation observation;      ///< For it; after the end, of the end.
  /// What the action was worth, see reward.h [rad]; 0 before the first. A grasp is rated by the
  /// door's angle after Step(): where the later stages are the caller's, that is before them.
  double reward = 0;
  bool terminated = false;              ///< The episode has come to an end of its own: see `cause`.
  bool truncated = false;               ///< It was ended by the number of actions.
  std::optional<EpisodeOutcome> cause;  ///< It says why the episode ended; kOpened is success.

  bool over() const { return terminated || truncated; }
};

/// A point in an episode to come back to, see EpisodeStepper::Save(). A value; copies share bytes.
class EpisodeImage {
 private:
  friend class EpisodeStepper;
  struct Content;
  std::shared_ptr<const Content> content_;
};

/// Episodes of one door, action by action: RunStages() with the loop turned inside out. Stages,
/// causes and thresholds are RunStages()'s, which is built on this.
///
///     EpisodeStepper stepper(door, robot);
///     Observation seen = stepper.Reset(scene);
///     while (!stepper.now().over()) seen = stepper.Step(MyAction(seen)).observation;
///
/// Deterministic: the same scene and the same actions give the same bits. Serves one thread.
class EpisodeStepper {
 public:
  /// @param door, robot Must outlive this, as what `options` points to.
  EpisodeStepper(const DoorAsset& door, const RobotModel& robot, StepperOptions options = {});
  ~EpisodeStepper();
  EpisodeStepper(EpisodeStepper&&) noexcept;
  EpisodeStepper& operator=(EpisodeStepper&&) noexcept;

  /// Begins an episode and runs it to the caller's first decision. If the rules before it fail,
  /// the episode is over already, see now(): a caller that learns samples another scene.
  ///
  /// @param observer Makes the clouds; null: they are empty.
  /// @throws Error(kInvalidArgument) if the scene is of another door or robot, or as DoorWorld
  ///     does; Error(kInvalidConfig) as CheckEpisodeLimits().
  Observation Reset(const Scene& scene, Observer* observer = nullptr);

  /// Carries out an action for PhysicsConfig::steps_per_action steps (longer where
  /// PhysicsConfig::hand_force_n makes the hand slow), and whatever the options leave to others
  /// after it. At the stage "grasp" the action is the contact point in the world
  /// and the hand's rotation.
  ///
  /// @return now(), until the next call.
  /// @throws Error(kInvalidArgument) before Reset(), after the end of the episode, and for an
  ///     action as BadAction says.
  const StepResult& Step(const Action& action);
  /// The stage "grasp" with all that a SnapshotGraspPolicy says; nothing: there is none to take
  /// hold of.
  const StepResult& Step(const std::optional<GraspCommand>& grasp);

  /// Gives the episode as the last Step() or Reset() left it.
  const StepResult& now() const;
  const WorldState& state() const;
  SceneSnapshot Snapshot() const;  ///< For a SnapshotGraspPolicy.
  /// The record so far, without decisions; its outcome is `cause`, and kOpened where there is none.
  Episode Summary() const;

  /// The episode as it is now: world, controller, contacts, counters, and the observer's memory.
  /// Policies that are the caller's or in the options keep what they remember for themselves.
  EpisodeImage Save() const;
  /// Back to that point: the same actions then give the same bits. Quick (a copy of the world's
  /// memory), so also a way to begin many episodes behind one grasp.
  ///
  /// @throws Error(kInvalidArgument) if the image is of another episode: Reset() ends them.
  const StepResult& Restore(const EpisodeImage& image);

 private:
  class Running;
  Running& Live() const;
  Running& Playing(const std::string& what) const;

  const DoorAsset* door_;
  const RobotModel* robot_;
  StepperOptions options_;
  std::unique_ptr<Running> running_;
};

}  // namespace doorforge

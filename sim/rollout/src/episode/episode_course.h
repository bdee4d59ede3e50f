// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "doorforge/rollout/handle_rule.h"
#include "doorforge/rollout/run_episode.h"

#include "episode/contact_log.h"
#include "episode/episode_world.h"

namespace doorforge::internal {

/// The way of one episode through its stages, grasp, handle, opening: carries out what is decided,
/// and says when a stage and when the episode is over, and why. Who decides is not its business.
class EpisodeCourse {
 public:
  /// @param handle_turned As EpisodePolicies::handle_turned.
  /// @param gives_up, grasps As of EpisodePolicies.
  EpisodeCourse(EpisodeWorld& world, HandleTurned handle_turned, GivesUp gives_up, int grasps)
      : world_(world),
        handle_turned_(std::move(handle_turned)),
        gives_up_(std::move(gives_up)),
        grasps_(grasps) {}

  /// The stage "grasp"; nothing where no point to take hold of is in view.
  void Grasp(std::optional<GraspCommand> grasp);
  /// The stage "handle", action by action, begins: it may be over at once.
  void BeginTurn() { EndTurnIfDone(); }
  /// One action at the stage "handle" or "open", held for its time; what it was worth.
  double Act(const Action& action);
  /// The whole stage "handle" by a rule, in the place of BeginTurn() and actions.
  void Turn(HandleRule& rule);

  Stage stage() const { return state_.stage; }
  bool over() const { return state_.over; }
  bool truncated() const { return state_.truncated; }
  EpisodeOutcome outcome() const;  ///< It exists only of an episode that is over.
  /// The record without decisions.
  Episode Summary() const;

  /// All that changes. A value.
  struct State {
    Stage stage = Stage::kGrasp;
    bool over = false;
    bool truncated = false;  // by the number of actions
    int actions = 0;         // of the present stage
    double grasp_cost = 0;
    int grasps = 0;     // taken so far
    std::string early;  // how far the handle was, where a predicted flag came too early
    bool handle_turned = false;
    std::optional<Verdict> failure;
    ContactLog log;
  };
  const State& state() const { return state_; }
  void Restore(const State& state) { state_ = state; }

 private:
  double TimeOf(const Action& action) const;  ///< [s]
  const PhysicsConfig& physics() const { return world_.scene().physics; }
  void End(std::optional<Verdict> failure);
  void Fail(Verdict verdict);
  void BeginStage(Stage stage);
  std::optional<bool> ToldTurned() const;
  bool SaysTurned() const;
  bool IsGivenUp() const;
  void EndTurnIfDone();
  void FinishTurn();
  void BeginOpening();
  void EndOpeningIfDone();
  void FinishOpening();
  Verdict TurnVerdict(bool lost) const;
  OpeningEvidence OpeningNow() const;
  std::string Detail() const;

  EpisodeWorld& world_;
  HandleTurned handle_turned_;
  GivesUp gives_up_;
  int grasps_;
  State state_;
};

}  // namespace doorforge::internal

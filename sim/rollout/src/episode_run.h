// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "doorforge/core/rng.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/run_episode.h"

namespace doorforge::internal {

/// One running episode. Stages are called in order; each returns the failure that ends the episode,
/// or nothing.
class EpisodeRun {
 public:
  EpisodeRun(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
             const EpisodeRoles& roles, Observer* observer);

  using Failure = std::optional<EpisodeOutcome>;
  Failure TakeHold();                       ///< By the planned grasp.
  Failure TakeHold(GraspChooser& chooser);  ///< By a chosen one.
  Failure Unlock();                         ///< By rule, in one go.
  Failure Turn(Policy& handle);             ///< The same, decision by decision.
  Failure Open(Policy& opening);

  Episode Finish(Failure failure);

 private:
  void Plan(const GraspPlan& plan);
  Failure Reach();
  Failure Grasp();
  bool IsTurned() const;
  bool EndsTurn() const;
  Failure TurnFailure(bool lost);
  void RecordChoice(GraspAction chosen);
  void Step(const RobotCommand& command);
  void StepHand();
  int StepsIn(double seconds) const;
  bool MoveHand(const RigidTransform& world_from_hand, double speed_m_s);
  void CenterHand(const DoorContacts& contacts);
  double HandError(const RigidTransform& world_from_hand) const;

  RigidTransform WorldFromHandle(double handle_rad) const;
  double Slip() const;  ///< [m] of the tool centre in the handle's frame since the grasp.
  double TurnSlip() const;
  PrivilegedState Privileged() const;
  SceneSnapshot Snapshot(std::string_view stage) const;
  void Watch(std::string_view stage);
  void Decide(Policy& policy, Stage stage);
  void BeginStage(Policy& policy, Stage stage);
  bool LearnerDrives(Stage stage) const;
  Decision DecisionAt(const Observation& observation, const Action& action) const;
  Action WithNoise(const Action& action);
  void HoldAction();
  void NoteContacts();
  void NoteForce(const DoorContacts& contacts);
  void NoteSelfContact(const DoorContacts& contacts);
  Failure HeldUpBy(const DoorContacts& contacts);
  std::string Detail(Failure failure) const;

  const DoorAsset& door_;
  const RobotModel& robot_;
  EpisodeRoles roles_;
  bool chosen_ = false;  // whether somebody chose the grasp
  Observer* observer_;
  GraspPlan plan_;
  DoorWorld world_;
  HandController controller_;
  Episode episode_;
  RigidTransform handle_from_hand_at_grasp_ = RigidTransform::Identity();

  Rng action_noise_;
  std::optional<std::array<double, 6>> action_bias_;
  int actions_ = 0;    // of the present stage
  std::string early_;  // how far the handle was, where a predicted flag came too early

  // bookkeeping of contacts, in steps
  long step_ = 0;
  long last_pad_step_ = -1;
  long last_touch_step_ = -1;
  bool opened_ = false;
  bool coasted_ = false;
  bool diverged_ = false;
  Failure held_up_at_loss_;  // when the pads left the handle
  std::string why_lost_;
  std::string problem_;
  std::string touched_at_opening_;
  std::string touched_itself_;  // "link2-hand"; last seen
};

}  // namespace doorforge::internal

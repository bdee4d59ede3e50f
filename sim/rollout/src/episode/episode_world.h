// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/outcome_judge.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

#include "episode/force_governor.h"
#include "episode/force_peaks.h"

namespace doorforge::internal {

/// A scene at work: the simulated world, what commands the hand in it, and where everything is. It
/// judges nothing.
class EpisodeWorld {
 public:
  /// @param door With the scene's variation; must outlive this, as the robot.
  /// @param observer May be null.
  EpisodeWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
               Observer* observer);
  /// The robot's joints begin at `start` in the place of StartPosition().
  EpisodeWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
               Observer* observer, const JointVector& start);

  /// Advances by one step of the physics, with drives that yield to force where it is limited. Does
  /// nothing once the world has a fault.
  void Step(const RobotCommand& command);
  /// Advances by what the hand's controller commands. Where the hand's force is limited and its
  /// fingers have lost what they held, it stands still.
  void StepHand();
  int StepsIn(double seconds) const;
  /// Moves the hand in a straight line and waits for it; whether it has arrived.
  bool MoveHand(const RigidTransform& world_from_hand, double speed_m_s);

  const Scene& scene() const { return scene_; }
  const EpisodeLimits& limits() const { return scene_.limits; }
  const DoorAsset& door() const { return door_; }
  const RobotModel& robot() const { return robot_; }
  const DoorWorld& world() const { return world_; }
  const WorldState& state() const { return world_.state(); }
  const DoorContacts& contacts() const { return memory_.contacts; }  ///< Of the last step.
  HandController& controller() { return memory_.controller; }
  bool diverged() const { return world_.fault().has_value(); }

  /// What changes in the course of the episode, besides the world itself.
  struct Memory {
    HandController controller;
    ForceGovernor governor;
    GripWatch grip{};
    ForcePeaks forces{};
    DoorContacts contacts{};  // of the last step
    long step = 0;
    double peak_hinge_rad = 0;
    double peak_handle_rad = 0;
    RigidTransform handle_from_hand_at_grasp = RigidTransform::Identity();
  };
  const Memory& memory() const { return memory_; }
  long step() const { return memory_.step; }
  void NoteGrasp();  ///< The fingers have closed: slip is measured from here.

  RigidTransform WorldFromHandle(double handle_rad) const;
  double HandError(const RigidTransform& world_from_hand) const;  ///< [m]
  double Slip() const;      ///< [m] of the tool centre in the handle's frame since the grasp.
  double TurnSlip() const;  ///< [rad] of the hand there.
  Hindrance HindranceNow() const;
  PrivilegedState Privileged() const;
  SceneSnapshot Snapshot(EpisodePhase phase) const;
  void Watch(EpisodePhase phase) const;
  Observer* observer() const { return observer_; }

  WorldImage SaveWorld() const { return world_.Save(); }
  void Restore(const WorldImage& image, const Memory& memory);

 private:
  void NoteContacts(bool closing);
  RigidTransform HandleFromHand() const;

  Scene scene_;
  const DoorAsset& door_;
  const RobotModel& robot_;
  Observer* observer_;
  DoorWorld world_;
  DoorFacts facts_;
  Memory memory_;
};

}  // namespace doorforge::internal

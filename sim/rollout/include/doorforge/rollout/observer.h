// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <any>
#include <array>
#include <span>

#include "doorforge/core/named_enum.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// The part of an episode that an instant belongs to; its words stand in captions of pictures.
enum class EpisodePhase { kStart, kReach, kGrasp, kUnlock, kOpen, kEnd };
inline constexpr NamedValue<EpisodePhase> kEpisodePhases[] = {
    {EpisodePhase::kStart, "start"}, {EpisodePhase::kReach, "reach"},
    {EpisodePhase::kGrasp, "grasp"}, {EpisodePhase::kUnlock, "unlock"},
    {EpisodePhase::kOpen, "open"},   {EpisodePhase::kEnd, "end"}};
constexpr std::span<const NamedValue<EpisodePhase>> ValuesOf(EpisodePhase) {
  return kEpisodePhases;
}

/// Where everything is at one instant, in the world.
struct SceneSnapshot {
  RobotPose robot;
  std::array<RigidTransform, 3> door;  ///< Indexed by DoorLinkIndex.
  double time_s = 0;
  EpisodePhase phase = EpisodePhase::kStart;
  // An episode that runs fills these in, a scene that was put together does not.
  JointVector robot_position = {};  ///< Joints of the robot in their order [m or rad].
  double hinge_rad = 0;
  double handle_rad = 0;
  double bolt_m = 0;       ///< WorldState::bolt_m.
  double force_n = 0;      ///< Sum of the normal forces between robot and door in this step.
  double net_force_n = 0;  ///< Length of the sum of all forces of the robot on the door in it.
};

/// Looks at an episode while it runs. Episodes run without one as well: the physics does not
/// change.
class Observer {
 public:
  virtual ~Observer() = default;
  /// The cloud for a policy's decision; may be empty.
  virtual LabelledCloud Observe(const SceneSnapshot& snapshot) = 0;
  /// Called at the beginning, after each stage and at each decision.
  virtual void Watch(const SceneSnapshot& /*snapshot*/) {}
  /// Whether Follow() is wanted.
  virtual bool Follows() const { return false; }
  /// Called as often as decisions are taken, also while none are; the phase is not told.
  virtual void Follow(const SceneSnapshot& /*snapshot*/) {}
  /// What an observer remembers from look to look and a later look depends on, for
  /// EpisodeStepper::Save(); Restore() puts it back.
  virtual std::any Save() const { return {}; }
  virtual void Restore(const std::any& /*memory*/) {}
};

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// How an episode ended. Everything but kOpened is a failure with its one cause.
enum class EpisodeOutcome {
  kOpened,         ///< The hinge passed 45 degrees with the gripper still on the handle.
  kNotReached,     ///< The gripper did not get to the grasp pose.
  kGraspMissed,    ///< The fingers closed on nothing, or only one of them touches.
  kHandleSlipped,  ///< The grasp was lost while turning the handle.
  kHandleStuck,    ///< The grasp held, but the handle did not reach the unlock angle.
  kGripLost,       ///< The grasp was lost while opening, before 45 degrees.
  kDoorStuck,      ///< The grasp held, but the door stayed below 45 degrees in the budget.
  kJointLimit,     ///< One of these, because an arm joint was at its limit.
  kCollision,      ///< One of these, because the arm or the hand met the door.
  kDiverged,       ///< The physics became impossible, see DivergenceDetector.
};
std::string_view NameOf(EpisodeOutcome outcome);  ///< "opened", "not_reached", ...
/// Inverse of NameOf; nothing if the name is unknown.
std::optional<EpisodeOutcome> EpisodeOutcomeNamed(std::string_view name);
inline constexpr int kEpisodeOutcomeCount = 10;

/// Stages of the task, each with a policy of its own (UniDoorManip, Section 4). A record holds the
/// decisions of one of them.
enum class Stage { kOpen, kHandle, kGrasp };
std::string_view NameOf(Stage stage);  ///< "open", "handle", "grasp".
/// Inverse of NameOf; nothing if the name is unknown.
std::optional<Stage> StageNamed(std::string_view name);

/// All joints at one instant: 11 of the robot (slider x, slider y, 7 arm joints, 2 fingers; sliders
/// that it does not have are at 0), hinge, handle [m or rad], and how far a bolt is drawn back [m].
/// With the scene's poses of door and robot they say exactly where everything is.
using JointState = std::array<double, 14>;
inline constexpr std::size_t kStateHinge = 11;
inline constexpr std::size_t kStateHandle = 12;
inline constexpr std::size_t kStateBolt = 13;

/// One decision point of a stage: what was seen, what was asked for, what came of it.
struct Decision {
  LabelledCloud cloud;  ///< Empty where the episode was run without a camera.
  Proprioception proprioception{};
  /// It means what Action does; at the stage "grasp" the first three numbers are the contact point
  /// in the world.
  ActionVector action{};
  /// What the robot was told to do: the action with noise, or that of a learner who is corrected by
  /// it. At the stage "grasp" the action itself.
  ActionVector executed{};
  JointState state{};  ///< Before the action.
  double time_s = 0;
  double hinge_rad = 0;   ///< Before the action.
  double handle_rad = 0;  ///< Before the action.
  /// The critic's target (UniDoorManip, Section 4) [rad]: the angle that the executed action
  /// gained, of the hinge at the stage "open", of the handle at "handle"; at "grasp" the door's
  /// final angle, at least 0.
  double angle_gain_rad = 0;
};

struct Episode {
  Scene scene;
  EpisodeOutcome outcome = EpisodeOutcome::kDiverged;
  std::string detail;               ///< The numbers that explain the outcome, for people.
  std::vector<Decision> decisions;  ///< They are those of the recorded stage, in order.
  double peak_hinge_rad = 0;
  double peak_handle_rad = 0;
  double simulated_s = 0;
  int grasps = 1;              ///< So many times the hand took hold.
  bool handle_turned = false;  ///< The stages before opening succeeded: held, turned, unlocked.
  /// Greatest sum of the normal forces between robot and door in one step [N].
  double peak_force_n = 0;
  /// Greatest sum of all forces of the robot on the door, as a vector, behind a low-pass filter of
  /// first order at 10 Hz [N]. The squeeze of the fingers is not in it.
  double peak_net_force_n = 0;
  std::string state_sha256;  ///< Hash of the final joint state: equal runs have equal hashes.
};

/// The record in a shard's .meta.json: scene, outcome, peaks, per-decision times. No arrays,
/// and none of `handle_turned`, `peak_force_n` and `peak_net_force_n`, which are for those who run
/// the episode.
nlohmann::ordered_json EpisodeMetaToJson(const Episode& episode);
Episode EpisodeFromMeta(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge

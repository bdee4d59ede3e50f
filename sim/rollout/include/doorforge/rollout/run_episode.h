// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Which joint of the robot each of the 11 joint places of Proprioception and of JointState holds;
/// -1: none, the place is 0.
using ProprioceptionPlaces = std::array<int, kRobotJointCount>;

/// Whether the 32 numbers are defined for the robot: seven arm joints, on sliders or a fixed base
/// (which stands for sliders at rest), or a flying hand.
bool HasProprioception(const RobotModel& robot);

/// Two sliders, seven arm joints, two fingers; without sliders their places are empty; of a flying
/// hand the places of the sliders and of the first four arm joints have its six joints.
/// Throws Error(kInvalidArgument) for a robot without.
ProprioceptionPlaces ProprioceptionPlacesOf(const RobotModel& robot);

/// UniDoorManip's 32 numbers, see Proprioception in policy.h. The base is the sliders' fixed root.
/// Throws Error(kInvalidArgument) for a robot without, and for a state of another robot.
Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base);

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

/// A grasp that somebody chose by looking at the closed door.
struct ChosenGrasp {
  LabelledCloud cloud;                                  ///< What was seen; point 0 is the contact.
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();  ///< In the world, on the surface seen.
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
  /// How the arm gets there, of whoever has planned that as well; without it, PlanReach() does.
  std::optional<GraspPlan> plan = std::nullopt;
  /// Whether the hand has to arrive and both pads to touch the handle before the episode goes on;
  /// else one pad is enough, to see what comes of it.
  bool both_pads = false;
};

/// Chooses where the hand takes hold, once, before the robot moves.
class GraspChooser {
 public:
  virtual ~GraspChooser() = default;
  /// Nothing where no point to take hold of is in view.
  virtual std::optional<ChosenGrasp> Choose(const SceneSnapshot& snapshot) = 0;
};

/// How far beyond the contact point the tool centre goes along the hand's z: with the pads' middle
/// there, they hold what lies behind a surface point that a camera sees.
inline constexpr double kGraspInsertion = 0.012;  // [m]

/// Who acts at each stage, and whose decisions the episode holds.
struct EpisodeRoles {
  Stage recorded = Stage::kOpen;
  GraspChooser* grasp = nullptr;  ///< Null: ExpertGrasp.
  Policy* handle = nullptr;       ///< Null: ExpertUnlock, which turns it in one go.
  /// Asked after each action of `handle`, and not before the first: whether the handle is turned.
  /// Opening begins after the first yes, whatever the simulator knows, also of doors without a
  /// latch. Null: the simulator's flag, turned to "handle done" and unlocked, which doors without
  /// a latch are from the start.
  std::function<bool()> predicted_turned = nullptr;
  Policy* open = nullptr;  ///< Never null.
  /// Drives the first `learner_decisions` of the recorded stage in the place of that stage's
  /// policy, which is asked at each of them what it would do: the record's action corrects the
  /// learner on the states that it gets itself into (Ross et al. 2011). Null: nobody.
  Policy* learner = nullptr;
  int learner_decisions = 0;
};

/// Runs one episode of the three stages: grasp, turn of the handle until it is "handle done" and
/// unlocked (at most max_handle_actions decisions), opening as in RunEpisode(). The physics' action
/// noise is added to the actions of the recorded stage alone, and not to a learner's: those of
/// later stages show what comes of it. `observer` is asked for clouds at recorded decisions and by
/// policies that look.
///
/// Outcomes are RunEpisode()'s. If a predicted flag came before the handle was "handle done", and
/// it never was later, a door that stays locked is kHandleStuck, and `handle_done` is false. If it
/// does not come within max_handle_actions and the hand still holds, opening is tried all the same:
/// whoever is not told cannot know whether there is a latch, but by trying. A
/// chosen grasp is tried as it is: the fingers close also where the hand did not quite arrive, and
/// one pad on the handle is enough to go on. Without a grasp in view the episode is kNotReached,
/// without decisions.
///
/// @throws Error(kInvalidArgument) as RunEpisode(), or if the recorded stage has nobody to decide.
Episode RunStages(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const EpisodeRoles& roles, Observer* observer);

}  // namespace doorforge

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/named_enum.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode_limits.h"
#include "doorforge/schemas/robot_base.h"

namespace doorforge {

/// What moves the arm.
enum class ArmController {
  kJointMotors,       ///< Position drives follow joint angles found by damped least squares.
  kOperationalSpace,  ///< Torques follow the hand's pose (Khatib 1987).
};
inline constexpr NamedValue<ArmController> kArmControllers[] = {
    {ArmController::kJointMotors, "joint_motors"},
    {ArmController::kOperationalSpace, "operational_space"}};
constexpr std::span<const NamedValue<ArmController>> ValuesOf(ArmController) {
  return kArmControllers;
}

/// Whose physics moves robot and door.
enum class Simulator {
  kBullet,  ///< Everything is collected and trained in this one.
  kMujoco,  ///< A second opinion on policies: same scene, robot, commands and judge.
};
inline constexpr NamedValue<Simulator> kSimulators[] = {{Simulator::kBullet, "bullet"},
                                                        {Simulator::kMujoco, "mujoco"}};
constexpr std::span<const NamedValue<Simulator>> ValuesOf(Simulator) { return kSimulators; }

/// How door, robot and room look in pictures; nothing else depends on it.
enum class SceneAppearance {
  kOff,     ///< Doors have their authors' colours, in a plain room under the same lamps.
  kColour,  ///< Colours of everything are drawn.
  kFull,    ///< Materials, textures, lamps, exposure and the camera's faults as well.
};
inline constexpr NamedValue<SceneAppearance> kSceneAppearances[] = {
    {SceneAppearance::kOff, "off"},
    {SceneAppearance::kColour, "colour"},
    {SceneAppearance::kFull, "full"}};
constexpr std::span<const NamedValue<SceneAppearance>> ValuesOf(SceneAppearance) {
  return kSceneAppearances;
}

/// Gains of the operational-space controller (Khatib 1987), see docs/robots.md.
struct OperationalSpaceConfig {
  double kp = 1500;        ///< It pulls the hand [1/s^2], critically damped. UniDoorManip: 200.
  double posture_kp = 10;  ///< It pulls the posture in what the hand leaves free [1/s^2].
  double armature = 0.01;  ///< It is added to the inertia of each joint [kg or kg m^2].
  double lead_m = 0.1;     ///< The hand's error counts no more than this,
  double lead_rad = 0.5;   ///< and no more than this.

  bool operator==(const OperationalSpaceConfig&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("kp", self.kp);
    visit("posture_kp", self.posture_kp);
    visit("armature", self.armature);
    visit("lead_m", self.lead_m);
    visit("lead_rad", self.lead_rad);
  }
};

/// Settings of the physics that change what happens in an episode.
struct PhysicsConfig {
  double time_step_s = 1.0 / 240;
  int solver_iterations = 50;
  /// Steps for which a policy's action is held: 1/6 s (UniDoorManip: 10 steps of 1/60 s).
  int steps_per_action = 40;
  double finger_friction = 1.5;  ///< Multiplied with the handle's for the contact.
  double handle_friction = 1.0;
  double finger_force_n = 80;
  int max_opening_actions = 25;  ///< UniDoorManip's evaluation budget.
  int max_handle_actions = 18;   ///< Where a policy turns the handle; UniDoorManip's rules.
  /// The episode goes on until the hinge has passed this angle; success is 45 degrees all the same.
  double finish_hinge_rad = 0.7853981633974483;
  /// Spread of the noise added to each executed action (the record keeps what the policy asked
  /// for), so that data show how to come back: Laskey et al., DART, CoRL 2017.
  double action_noise_m = 0;
  double action_noise_rad = 0;
  RobotBase base = RobotBase::kSliders;
  ArmController controller = ArmController::kJointMotors;
  OperationalSpaceConfig operational_space = {};
  /// What the hand may press the door with, beyond the squeeze of its fingers [N]; 0: as much as
  /// the joints' efforts give. It limits the joint motors, beyond what moving the arm takes
  /// (DriveLimits in sim/physics), and in episodes they yield while the force that a wrist would
  /// feel is greater (ForceGovernor in sim/rollout). What an arm has in momentum as it strikes it
  /// cannot take back, so it comes to a handle and leaves it at 7 cm/s at most, an action takes as
  /// long as its way needs at 5 cm/s (but for the part of it back along the fingers, and up to
  /// eight times as long as others), the hand stands still once it has lost a handle (GripWatch),
  /// and catches up slowly with what it was told while something held it up
  /// (HandControllerConfig::catch_up).
  double hand_force_n = 0;
  Simulator simulator = Simulator::kBullet;  ///< Written into files only where it is another.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("time_step_s", self.time_step_s);
    visit("solver_iterations", self.solver_iterations);
    visit("steps_per_action", self.steps_per_action);
    visit("finger_friction", self.finger_friction);
    visit("handle_friction", self.handle_friction);
    visit("finger_force_n", self.finger_force_n);
    visit("max_opening_actions", self.max_opening_actions);
    visit("max_handle_actions", self.max_handle_actions);
    visit("finish_hinge_rad", self.finish_hinge_rad);
    visit("action_noise_m", self.action_noise_m);
    visit("action_noise_rad", self.action_noise_rad);
    visit("base", self.base);
    visit("controller", self.controller);
    visit("operational_space", self.operational_space);
    visit("hand_force_n", self.hand_force_n);
    // Records from before there was a choice stay as they are. One that is read is not const.
    if (!std::is_const_v<Self> || self.simulator != Simulator::kBullet)
      visit("simulator", self.simulator);
  }
};

/// Factors on what the door's record says, drawn for one scene.
struct DoorVariation {
  double leaf_mass = 1;  ///< On mass and inertia.
  double handle_mass = 1;
  double hinge_damping = 1;
  double handle_damping = 1;

  bool operator==(const DoorVariation&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf_mass", self.leaf_mass);
    visit("handle_mass", self.handle_mass);
    visit("hinge_damping", self.hinge_damping);
    visit("handle_damping", self.handle_damping);
  }
};

/// The door with these factors applied.
DoorAsset ApplyVariation(const DoorAsset& door, const DoorVariation& variation);

/// A robot that is not the built-in one: name of its URDF and RobotModel::sha256().
struct RobotIdentity {
  std::string name;
  std::string sha256;

  bool operator==(const RobotIdentity&) const = default;
};

/// Everything that decides an episode, except the policies. Plain data; same scene, same door, same
/// policies: same episode.
struct Scene {
  std::string door_id;
  std::string door_sha256;
  std::uint64_t seed = 0;
  std::uint64_t episode = 0;  ///< Index within its plan; names the random streams.
  RigidTransform world_from_door = RigidTransform::Identity();
  RigidTransform world_from_robot_base = RigidTransform::Identity();
  RobotIdentity robot;  ///< It is empty for the built-in one; the record then has no such field.
  Latch latch;          ///< With the scene's springs and unlock angle.
  DoorVariation variation;  ///< It changes the rest of the door.
  /// Added to the seven arm joints of the robot's initial position.
  std::array<double, 7> arm_start_offset_rad{};
  /// Offset of the expert's grasp from the door's grasp frame, in the grasp frame.
  RigidTransform grasp_from_noisy_grasp = RigidTransform::Identity();
  PhysicsConfig physics;
  EpisodeLimits
      limits;  ///< The record has them, as "episode_limits", where they are not the defaults.
  CameraModel camera;
  SceneAppearance appearance = SceneAppearance::kOff;  ///< The record has it where it is not off.
};

/// Settings that joined the record later are left out of it where they have their default value.
nlohmann::ordered_json SceneToJson(const Scene& scene);
Scene SceneFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge

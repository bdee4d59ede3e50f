// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "doorforge/physics/divergence_detector.h"
#include "doorforge/physics/robot_command.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

namespace internal {
struct SavedWorld;
class WorldEngine;
}  // namespace internal

struct WorldState {
  JointVector robot_position;
  JointVector robot_velocity;
  double hinge_rad = 0;
  double hinge_rad_s = 0;
  double handle_rad = 0;
  double handle_rad_s = 0;
  bool locked = false;       ///< The latch holds the leaf, see Latch in door_asset.h.
  bool handle_done = false;  ///< The handle has reached handle_done_angle_rad once in this episode.
  double bolt_m = 0;         ///< 0 thrown, negative drawn back; see bolt.h. 0 where there is none.
  double bolt_m_s = 0;
  double time_s = 0;
};

/// What the robot touches of the door after a step. Two shapes touch if they are nearer than 1 mm.
struct DoorContacts {
  std::array<int, 2> pad_points{};      ///< Left and right finger with the handle.
  std::array<double, 2> pad_force_n{};  ///< Sum of the normal forces of these points.
  double deepest_m = 0;                 ///< Deepest overlap of a finger and the handle, >= 0.
  /// Smallest finger to handle distance that the solver looks at; 0.02 or more is reported as 0.02.
  double pad_distance_m = 0.02;
  int arm_points = 0;       ///< Any other pair of robot and door.
  double arm_force_n = 0;   ///< Sum of their normal forces.
  std::string arm_touches;  ///< Such as "hand-leaf"; empty if there are none.
  int self_points = 0;      ///< The robot touches itself at so many.
  /// Sum of all forces of the robot on the door, friction included, in the world. The squeeze of
  /// two opposed fingers is not in it: its two sides add up to nothing.
  Eigen::Vector3d force_on_door_n = Eigen::Vector3d::Zero();
  double self_force_n = 0;
  std::string self_touches;  ///< Such as "link2-hand"; empty if there are none.

  bool AnyPad() const { return pad_points[0] > 0 || pad_points[1] > 0; }
  bool BothPads() const { return pad_points[0] > 0 && pad_points[1] > 0; }
};

/// Everything that the next steps of one DoorWorld depend on: joints, speeds, latch, cached
/// contacts with their impulses, the broadphase's trees. Of the world that it was saved from,
/// alone; a value whose copies share the bytes.
class WorldImage {
 public:
  std::size_t size_bytes() const;  ///< About; 0 for an empty one.

 private:
  friend class DoorWorld;
  std::shared_ptr<const internal::SavedWorld> content_;
};

/// Whether this build has the simulator.
bool HasSimulator(Simulator simulator);

/// Throws Error(kInvalidConfig) that says what to install where this build, or this machine, does
/// not have the simulator. For programs, before hours of work.
void RequireSimulator(Simulator simulator);

/// The simulated scene: robot, door and latch in a Bullet multibody world, double precision; or, as
/// PhysicsConfig::simulator says, in MuJoCo, with the same bodies, drives, latch law and frictions:
/// docs/design/notes/2026-11-27-second-simulator.md.
///
/// Contacts are Coulomb friction between convex hulls; nothing is ever glued to the gripper. The
/// latch is the effort law of Latch, or a bolt that meets its strike in contact. Gravity is off for
/// robot and door, as in UniDoorManip; the other departures are in docs/design/simulation.md.
///
/// Deterministic: the same scene, door and commands give the same states bit by bit, in any number
/// of worlds side by side (each world belongs to one thread at a time).
class DoorWorld {
 public:
  /// The robot starts in `start` (fingers open), the door closed, everything at rest.
  ///
  /// @throws Error(kInvalidArgument) if a setting of the scene's physics is out of range, or if a
  ///     link of the door has no mass or a hull of fewer than four points; as RequireSimulatable()
  ///     and RequireSimulator().
  DoorWorld(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
            const JointVector& start);
  ~DoorWorld();
  DoorWorld(DoorWorld&&) noexcept;
  DoorWorld& operator=(DoorWorld&&) noexcept;

  /// Advances by the scene's time step. Does nothing any more after a fault.
  void Step(const RobotCommand& command);

  const WorldState& state() const;
  DoorContacts Contacts() const;

  /// A force at a point of the leaf during the next step only, both in the leaf's frame: for
  /// experiments without a robot.
  void PushLeaf(const Eigen::Vector3d& point_m, const Eigen::Vector3d& force_n);
  /// Torque about the handle's axis during the next step only [N m].
  void TurnHandle(double torque_nm);

  /// Poses of base, leaf and handle in the world.
  std::array<RigidTransform, 3> WorldFromDoorLinks() const;
  RobotPose PoseOfRobot() const;

  /// Puts the joints where `state` says, at its speeds; the latch stays as it is. To the watch this
  /// is not an input: a jump is a fault like any other.
  ///
  /// @throws Error(kInvalidArgument) if `state` has another number of joints.
  void Place(const WorldState& state);

  /// The state as it is now, to come back to. The world goes on as if it had not been asked.
  WorldImage Save() const;
  /// Puts the world back into a state: the same commands then give the same bits as they did after
  /// Save(), as often as wanted and in any order of images.
  ///
  /// @throws Error(kInvalidArgument) if the image is empty, or was saved from another world: images
  ///     do not outlive their world, and cannot be written to a file.
  void Restore(const WorldImage& image);

  /// What made the simulated state impossible, see DivergenceDetector; nothing as long as it is
  /// plausible.
  const std::optional<StateFault>& fault() const;

  /// SHA-256 of all joint positions and velocities, bit by bit, a bolt's among them.
  std::string StateHash() const;

 private:
  std::unique_ptr<internal::WorldEngine> engine_;
};

}  // namespace doorforge

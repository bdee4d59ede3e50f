// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "doorforge/physics/door_world.h"

namespace doorforge::internal {

/// What a WorldImage holds: a state with all that the next steps depend on. Each simulator adds its
/// own part.
struct SavedWorld {
  virtual ~SavedWorld() = default;
  virtual std::size_t size_bytes() const = 0;

  std::weak_ptr<const void> world;  ///< The one that it is of.
  WorldState state;
  std::optional<StateFault> fault;
  double extra_hinge_torque = 0;
  double extra_handle_torque = 0;
};

/// A simulator at work on one scene; DoorWorld is its face. What it has to keep to is written
/// there.
class WorldEngine {
 public:
  virtual ~WorldEngine() = default;
  WorldEngine(const WorldEngine&) = delete;
  WorldEngine& operator=(const WorldEngine&) = delete;

  /// Sets state and fault. Is called only without a fault, with a finite command.
  virtual void Step(const RobotCommand& command) = 0;
  /// Is called only with as many joints as the robot has.
  virtual void Place(const WorldState& at) = 0;
  virtual DoorContacts Contacts() const = 0;

  std::shared_ptr<const SavedWorld> Save() const;
  /// @param image Of this world.
  void Restore(const SavedWorld& image);

  Scene scene;
  DoorAsset door;
  RobotModel robot;
  WorldState state;
  std::optional<StateFault> fault;
  double extra_hinge_torque = 0;  ///< In the next step only [N m].
  double extra_handle_torque = 0;

 protected:
  WorldEngine(const Scene& the_scene, const DoorAsset& the_door, const RobotModel& the_robot)
      : scene(the_scene), door(the_door), robot(the_robot) {}

  /// The simulator's own part alone.
  virtual std::shared_ptr<SavedWorld> SaveOwn() const = 0;
  virtual void RestoreOwn(const SavedWorld& image) = 0;

 private:
  std::shared_ptr<const void> identity_ = std::make_shared<int>();
};

/// The scene's physics and robot are checked by now.
std::unique_ptr<WorldEngine> MakeBulletEngine(const Scene& scene, const DoorAsset& door,
                                              const RobotModel& robot, const JointVector& start);
/// It throws as RequireMujoco().
std::unique_ptr<WorldEngine> MakeMujocoEngine(const Scene& scene, const DoorAsset& door,
                                              const RobotModel& robot, const JointVector& start);

/// Whether it was found when this was configured.
bool BuiltWithMujoco();
/// Throws Error(kInvalidConfig) unless BuiltWithMujoco() and the library can be loaded.
void RequireMujoco();

}  // namespace doorforge::internal

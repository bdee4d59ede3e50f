// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "doorforge/physics/divergence_detector.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

#include "collision/bullet_body.h"

namespace doorforge::internal {

/// Measures each step of a robot and a door for a DivergenceDetector.
class StepEnergyAudit {
 public:
  /// @param robot, door Must outlive this. Links of the robot are its joints; the door's first two
  ///     are hinge and handle.
  StepEnergyAudit(const BulletBody& robot, const BulletBody& door, const RobotModel& model,
                  const DoorAsset& asset);

  /// To be called when all torques of the step are set. A fault says that the state must not be
  /// stepped.
  std::optional<StateFault> BeforeStep(double time_s);
  /// To be called after the step.
  std::optional<StateFault> AfterStep(btCollisionDispatcher& dispatcher, double time_step_s);

  /// What it knows of earlier steps.
  struct Memory {
    DivergenceDetector watch;
    WatchedStep step;
  };
  Memory memory() const { return {watch_, step_}; }
  void Restore(const Memory& memory) {
    watch_ = memory.watch;
    step_ = memory.step;
  }

 private:
  static constexpr int kDoorJoints = 2;  // hinge and handle are watched one by one

  void ReadJoints();
  std::optional<StateFault> CheckTorques(double time_s) const;
  double WorkOfStep(double time_step_s) const;

  const BulletBody& robot_;
  const BulletBody& door_;
  std::vector<double> drive_limit_;               // of the robot's joints [N m or N]
  std::array<double, kDoorJoints> torque_limit_;  // of hinge and handle [N m]
  DivergenceDetector watch_;
  WatchedStep step_;
  std::vector<double> torque_;  // applied, of the robot's links and then all of the door's
  std::vector<double> speed_before_;
};

}  // namespace doorforge::internal

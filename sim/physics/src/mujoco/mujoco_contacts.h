// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/door_world.h"

#include "mujoco/mujoco_model.h"
#include "mujoco/mujoco_scene.h"

namespace doorforge::internal {

/// The contacts of a model in the terms of the project: which bodies, with which friction.
class MujocoContacts {
 public:
  /// @param model, robot Must outlive this.
  MujocoContacts(const MujocoModel& model, const std::vector<MujocoPiece>& pieces,
                 const RobotModel& robot);

  /// To be called between collision and constraints. Frictions are multiplied, which MuJoCo does
  /// not know, and fade where shapes overlap, as in RowSolver.
  void SetFrictions() const;

  /// What touches after the forces of a step are known.
  DoorContacts Report() const;
  double deepest_m() const;  ///< Of all overlaps, >= 0.

 private:
  const MujocoPiece& PieceOf(int geom) const { return pieces_[static_cast<std::size_t>(geom)]; }
  void AddDoorContact(int index, DoorContacts& contacts) const;
  void AddSelfContact(int index, DoorContacts& contacts) const;

  const MujocoModel& model_;
  const RobotModel& robot_;
  std::vector<MujocoPiece> pieces_;  // of each geom
};

}  // namespace doorforge::internal

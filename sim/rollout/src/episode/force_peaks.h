// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/door_world.h"

namespace doorforge::internal {

/// The greatest forces between robot and door since an episode began. A value.
class ForcePeaks {
 public:
  /// Once a step of the physics.
  void Note(const DoorContacts& contacts, double time_step_s);
  double normal_n() const { return normal_n_; }  ///< Episode::peak_force_n.
  double net_n() const { return net_n_; }        ///< Episode::peak_net_force_n.

 private:
  double normal_n_ = 0;
  double net_n_ = 0;
  Eigen::Vector3d filtered_n_ = Eigen::Vector3d::Zero();
};

}  // namespace doorforge::internal
